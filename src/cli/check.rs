//! `orthocert check`.

use super::input::Begun;
use super::pave::searched;
use super::{audit, input, print, Failure, Format, Status};
use crate::design::Design;
use crate::files::digest::Summed;
use crate::files::read::Named;
use crate::report::wrapped;
use crate::report::Size;
use crate::search::accepted::{check, Accepted};
use orthocert_checker::certificate::{Certificate, Verdict};
use orthocert_checker::{read, statement};
use orthocert_kernel::certificate::Claim;
use orthocert_kernel::claim::{MachineClaim, Workspace};
use orthocert_kernel::paving::{self, Header, Summary};
use orthocert_kernel::problem::Problem;
use orthocert_kernel::prover::check_sample;
use serde::Serialize;
use serde_json::{Map, Value};
use std::io::BufReader;
use std::path::PathBuf;

/// Longest text of a value in a message.
const LONGEST: usize = 60;
/// Most boxes of a sample, which are kept in memory.
const MAX_SAMPLE: u64 = 1_000_000;

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The certificate, or a paving; or a folder, all certificates of which are checked against the
    /// designs of the same names, and in which neither may lack the other
    #[arg(value_name = "CERT.json|PAVING|FOLDER")]
    certificate: PathBuf,
    /// Demand that the certificate is about this design's claim
    #[arg(long, value_name = "DESIGN.toml")]
    design: Option<PathBuf>,
    /// Of a paving: the box that it was searched in, in the place of the design's workspace
    #[arg(
        long = "box",
        value_name = "X0,X1,Y0,Y1,Z0,Z1",
        requires = "design",
        allow_hyphen_values = true
    )]
    search_box: Option<String>,
    /// With a folder: where the designs are [default: in the same folder]
    #[arg(long, value_name = "FOLDER", conflicts_with = "design")]
    designs: Option<PathBuf>,
    /// With a folder: certificates at a time [default: one for each core]
    #[arg(long, value_name = "N", value_parser = input::whole(1..=1024), allow_hyphen_values = true)]
    jobs: Option<u64>,
    /// Of a paving, evaluate the evidence of so many inner and outer boxes only, drawn at random;
    /// the others have to have evidence
    #[arg(long, value_name = "N", value_parser = input::whole(1..=MAX_SAMPLE), allow_hyphen_values = true)]
    sample: Option<u64>,
    /// The seed of the draw, to repeat one [default: from the system's randomness, and printed]
    #[arg(long, value_name = "S", requires = "sample",
        value_parser = input::whole(0..=u64::MAX), allow_hyphen_values = true)]
    seed: Option<u64>,
    /// Also print the formulas that the claim is about, of a machine of any kind: the inputs, and leg by
    /// leg A, D and the joint coordinate
    #[arg(long)]
    formulas: bool,
    /// The form of the answer
    #[arg(long, value_enum, default_value_t)]
    format: Format,
    /// Print the verdict's line only; with a folder, the line of totals
    #[arg(short, long, conflicts_with = "formulas")]
    quiet: bool,
}

/// The answer for scripts.
#[derive(Serialize)]
struct Answer<'a> {
    accepted: bool,
    verdict: Verdict,
    statement: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    formulas: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    proof: Option<Size>,
    claim: &'a Claim,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    if arguments.certificate.is_dir() {
        return folder(arguments);
    }
    if arguments.designs.is_some() || arguments.jobs.is_some() {
        let path = arguments.certificate.shown();
        return Err(Failure::Input(format!(
            "--designs, --jobs: {path} is no folder; accepted: with a folder of certificates"
        )));
    }
    // The design first: what is wrong with it is no defect of the certificate.
    let design = arguments.design.as_deref().map(Design::read).transpose();
    let design = design.map_err(Failure::input)?;
    if let Some(design) = &design {
        input::tell_notes(design, arguments.design.as_deref(), arguments.quiet);
    }
    let begun = Begun::new(&arguments.certificate, "a certificate or a paving")?;
    if paving::is_paving(&begun.start) {
        if arguments.formulas {
            return Err(without_formulas("a paving"));
        }
        return check_paving(arguments, begun, design.as_ref());
    }
    let bytes = begun.start;
    for (flag, is_given) in
        [("--sample", arguments.sample.is_some()), ("--box", arguments.search_box.is_some())]
    {
        if is_given {
            let refused = format!("{flag}: found a certificate; accepted: a paving");
            return Err(Failure::Input(refused));
        }
    }
    match examine(&bytes, design.as_ref()) {
        Ok((certificate, accepted)) => {
            let formulas = match arguments.formulas {
                true => Some(formulas(&certificate)?),
                false => None,
            };
            accept(arguments, &certificate, &accepted, formulas.as_deref())?;
            Ok(Status::Decided(accepted.verdict))
        }
        Err(reason) => reject(arguments, &reason),
    }
}

/// The answer about a paving, for scripts.
#[derive(Serialize)]
struct PavingAnswer<'a> {
    accepted: bool,
    statement: &'a str,
    /// Inner and outer boxes whose evidence was evaluated.
    checked: u64,
    /// The seed by which they were drawn.
    #[serde(skip_serializing_if = "Option::is_none")]
    seed: Option<String>,
    /// The SHA-256 of the bytes that were checked.
    sha256: &'a str,
    #[serde(flatten)]
    summary: &'a Summary,
    header: &'a Header,
}

fn check_paving(
    arguments: &Arguments,
    begun: Begun,
    design: Option<&Design>,
) -> Result<Status, Failure> {
    let seed = match (arguments.sample, arguments.seed) {
        (Some(_), None) => Some(random()?),
        (_, seed) => seed,
    };
    let mut input = BufReader::new(Summed::new(begun.whole()));
    let found = match arguments.sample.zip(seed) {
        Some((size, seed)) => check_sample(&mut input, size, seed).map(|sampled| {
            let words = sampled.statement();
            (sampled.accepted, words)
        }),
        None => paving::check(&mut input).map(|accepted| {
            let words = orthocert_kernel::statement::paving(&accepted);
            (accepted, words)
        }),
    };
    let accepted = found.map_err(|reason| reason.to_string());
    let wanted = match design {
        Some(design) => Some(searched(&design.claim, arguments.search_box.as_deref())?),
        None => None,
    };
    let accepted = accepted.and_then(|(accepted, words)| match wanted {
        Some(claim) if accepted.header.claim.machine != claim => {
            let machine = &accepted.header.claim.machine;
            let workspace = machine.workspace.clone();
            let is_box = matches!(workspace, Workspace::Box { .. });
            let there = MachineClaim { workspace, ..claim.clone() };
            let hint = match is_box && there == *machine {
                true => "; --box gives the box that was searched",
                false => "",
            };
            let found = Claim::Machine(accepted.header.claim.machine);
            Err(another_claim(&found, &Claim::Machine(claim)) + hint)
        }
        _ => Ok((accepted, words)),
    });
    match accepted {
        Ok((accepted, statement)) => {
            // An accepted paving was read to its end.
            let (sha256, _) = input.into_inner().finish().map_err(|error| {
                Failure::Input(format!("{}: {error}", arguments.certificate.shown()))
            })?;
            match arguments.format {
                Format::Text if arguments.quiet => {
                    // A sample is not the whole.
                    let drawn = |seed| format!(", by {} boxes of --seed {seed}", accepted.checked);
                    let drawn = seed.map(drawn).unwrap_or_default();
                    print::answer(&format!("ACCEPTED: paving{drawn}\n"))?;
                }
                Format::Text => {
                    let mut answer = format!("ACCEPTED: paving\n{statement}");
                    if let Some(seed) = seed {
                        answer += &format!("Drawn with --seed {seed}.\n");
                    }
                    answer += &format!("sha256 {sha256}\n");
                    print::answer(&wrapped(&answer))?;
                }
                Format::Json => print::json(&PavingAnswer {
                    accepted: true,
                    statement: &statement,
                    checked: accepted.checked,
                    seed: seed.map(|seed| seed.to_string()),
                    sha256: &sha256,
                    summary: &accepted.summary,
                    header: &accepted.header,
                })?,
            }
            Ok(Status::Done)
        }
        Err(reason) => {
            let drawn = seed.map(|seed| format!(" (drawn with --seed {seed})"));
            reject(arguments, &(reason + &drawn.unwrap_or_default()))
        }
    }
}

/// A seed that whoever made the paving did not know.
fn random() -> Result<u64, Failure> {
    getrandom::u64().map_err(|error| {
        Failure::Output(format!("--sample: the system has no randomness: {error}; --seed gives it"))
    })
}

fn reject(arguments: &Arguments, reason: &str) -> Result<Status, Failure> {
    let path = &arguments.certificate;
    print::rejected(arguments.format, path, &reason, &input::design_hint(path))
}

/// Checks all of a folder.
fn folder(arguments: &Arguments) -> Result<Status, Failure> {
    let Arguments { certificate, design, designs, jobs, format, sample, quiet, .. } = arguments;
    if arguments.formulas {
        return Err(without_formulas("a folder"));
    }
    if sample.is_some() {
        let message = "--sample: found with a folder; accepted: with one paving";
        return Err(Failure::Input(message.to_owned()));
    }
    if let Some(design) = design {
        return Err(Failure::Input(format!(
            "--design: found {} with a folder of certificates; accepted: --designs FOLDER",
            design.shown()
        )));
    }
    let designs = designs.as_ref().unwrap_or(certificate);
    audit::run(certificate, designs, *jobs, (*format, *quiet))
}

/// Whether a certificate's claim is that of the design.
pub fn is_of(certificate: &Certificate, design: &Design) -> bool {
    matches!(&certificate.claim, Claim::Machine(claim) if *claim == design.claim)
}

/// Accepts a certificate, or says why not.
pub fn examine(bytes: &[u8], design: Option<&Design>) -> Result<(Certificate, Accepted), String> {
    let certificate = read(bytes).map_err(|reason| reason.to_string())?;
    if let Some(design) = design {
        if !is_of(&certificate, design) {
            let claim = Claim::Machine(design.claim.clone());
            return Err(another_claim(&certificate.claim, &claim));
        }
    }
    let accepted = check(&certificate).map_err(|reason| reason.to_string())?;
    Ok((certificate, accepted))
}

/// The formulas that a certificate's claim is about.
fn formulas(certificate: &Certificate) -> Result<String, Failure> {
    let Claim::Machine(claim) = &certificate.claim else {
        return Err(without_formulas("a certificate that is not checked by formulas"));
    };
    // The certificate was accepted, so that its claim is well formed.
    let problem = Problem::new(claim).map_err(Failure::input)?;
    crate::report::formulas::formulas(&problem).map_err(Failure::input)
}

fn without_formulas(found: &str) -> Failure {
    Failure::Input(format!("--formulas: found {found}; accepted: one certificate about a machine"))
}

fn accept(
    arguments: &Arguments,
    certificate: &Certificate,
    accepted: &Accepted,
    formulas: Option<&str>,
) -> Result<(), Failure> {
    let verdict = accepted.verdict;
    let statement = statement::established(certificate);
    match arguments.format {
        Format::Text if arguments.quiet => print::answer(&format!("ACCEPTED: {verdict}\n")),
        Format::Text => {
            let mut answer = wrapped(&format!("ACCEPTED: {verdict}\n{statement}"));
            if let Some(formulas) = formulas {
                // Not wrapped: a line is a formula.
                answer += &format!("\nIts formulas:\n{formulas}");
            }
            print::answer(&answer)
        }
        Format::Json => {
            let proof = Size::accepted(&certificate.proof, &accepted.size);
            let (accepted, statement, claim) = (true, statement.as_str(), &certificate.claim);
            print::json(&Answer { accepted, verdict, statement, formulas, proof, claim })
        }
    }
}

/// The sentence for a certificate of another claim than the design's.
fn another_claim(certified: &Claim, designed: &Claim) -> String {
    let same = "it is about another claim than the design's";
    match (serde_json::to_value(certified), serde_json::to_value(designed)) {
        (Ok(certified), Ok(designed)) => match difference(&certified, &designed, "claim") {
            Some((key, found, wanted)) => {
                let key = key_of_design(&key);
                format!("{same}: {key} is {found} in the certificate and {wanted} in the design")
            }
            None => same.to_owned(),
        },
        _ => same.to_owned(),
    }
}

/// A key of a claim as a design has it, where both have the same numbers.
fn key_of_design(key: &str) -> String {
    const ALIKE: [(&str, &str); 6] = [
        ("mechanism.translational.", "mechanism.legs."),
        ("mechanism.formulas.", "mechanism."),
        ("mechanism.planar.", "mechanism."),
        ("mechanism.spatial.", "mechanism."),
        ("mechanism.spherical.", "mechanism."),
        ("workspace.box.", "workspace."),
    ];
    let Some(own) = key.strip_prefix("claim.machine.") else { return key.to_owned() };
    let alike = ALIKE.iter().find_map(|(claim, design)| Some((own.strip_prefix(claim)?, design)));
    alike.map_or_else(|| own.to_owned(), |(rest, design)| format!("{design}{rest}"))
}

/// The first place at which two values differ, and what stands there.
fn difference(one: &Value, other: &Value, key: &str) -> Option<(String, String, String)> {
    match (one, other) {
        // Variants of one thing are told apart by their only key.
        (Value::Object(a), Value::Object(b))
            if a.len() == 1 && b.len() == 1 && !a.keys().eq(b.keys()) =>
        {
            let is_short = [one, other].iter().all(|x| x.to_string().chars().count() <= LONGEST);
            let named = |map: &Map<String, Value>| map.keys().cloned().collect::<String>();
            match is_short {
                true => Some((key.to_owned(), shown(one), shown(other))),
                false => Some((key.to_owned(), named(a), named(b))),
            }
        }
        (Value::Object(a), Value::Object(b)) => {
            // What a requirement is of comes before its numbers.
            let first = a.get_key_value("quantity").map(|(key, _)| key);
            let keys = a.keys().chain(b.keys().filter(|k| !a.contains_key(*k)));
            first.into_iter().chain(keys).find_map(|k| {
                let of = |map: &Map<String, Value>| map.get(k).cloned().unwrap_or(Value::Null);
                difference(&of(a), &of(b), &format!("{key}.{k}"))
            })
        }
        // Where one list goes on, what the other lacks is absent.
        (Value::Array(a), Value::Array(b)) => (0..a.len().max(b.len())).find_map(|i| {
            let of = |list: &[Value]| list.get(i).cloned().unwrap_or(Value::Null);
            difference(&of(a), &of(b), &format!("{key}.{i}"))
        }),
        _ if one == other => None,
        _ => Some((key.to_owned(), shown(one), shown(other))),
    }
}

fn shown(value: &Value) -> String {
    let text = match value {
        Value::Null => return "absent".to_owned(),
        Value::String(text) => text.clone(),
        value => value.to_string(),
    };
    if text.chars().count() <= LONGEST {
        return text;
    }
    text.chars().take(LONGEST).chain("...".chars()).collect()
}
