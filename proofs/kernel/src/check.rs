//! What a certificate has to be to be accepted.

use crate::certificate::{Certificate, Claim, Proof, Verdict};
use crate::claim::MachineClaim;
use crate::problem::Problem;
use crate::rejected::Rejected;
use crate::{atlas, no_cube, postulate, tree, witness, work};

/// Accepts a certificate, or says why not.
///
/// # Errors
/// If its proof does not show what its verdict says of its claim.
pub fn check(certificate: &Certificate) -> Result<(), Rejected> {
    use Verdict::{Certified, Refuted};
    let problem = |claim: &MachineClaim| -> Result<Problem, Rejected> {
        Ok(Problem { most_work: work::OF_ONE, ..Problem::new(claim)? })
    };
    match (&certificate.claim, certificate.verdict, &certificate.proof) {
        (Claim::Machine(claim), Certified, Proof::Tree(tree)) => {
            tree::check(&problem(claim)?.with_derivatives_for(tree), tree)
        }
        (Claim::Machine(claim), Refuted, Proof::Witness(witness)) => {
            Ok(witness::check(&Problem::new(claim)?, &claim.workspace, witness)?)
        }
        (Claim::NoCube(claim), Certified, Proof::Tree(tree)) => {
            no_cube::check(claim, problem(&claim.machine)?, tree)
        }
        (Claim::Postulate(claim), Certified, Proof::Tree(tree)) => postulate::check(claim, tree),
        (Claim::Atlas(claim), Certified, Proof::Atlas(cells)) => {
            atlas::check_part(claim, cells, |_| true)
        }
        _ => Err(Rejected::Verdict),
    }
}
