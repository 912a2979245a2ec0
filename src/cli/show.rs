//! `orthocert show`.

use super::{input, print, Failure, Format, Status};
use crate::exact::decimal::{boxes, exact, grouped};
use crate::report::counterexample;
use crate::report::text::{labelled, wrap};
use crate::report::wrapped;
use crate::search::accepted::{size_of, trees, TreeSize};
use orthocert_checker::certificate::{Certificate, Proof, Provenance, Verdict};
use orthocert_checker::{read, statement};
use orthocert_kernel::certificate as kernel;
use orthocert_kernel::certificate::{AtlasCell, Claim};
use orthocert_kernel::paving::is_paving;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The certificate
    #[arg(value_name = "CERT.json")]
    certificate: PathBuf,
    /// The form of the answer
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// What a certificate says of itself.
#[derive(Serialize)]
struct Shown<'a> {
    checked: bool,
    stated_verdict: Verdict,
    bytes: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    tree: Option<Shape>,
    #[serde(skip_serializing_if = "Option::is_none")]
    witness: Option<&'a kernel::Witness>,
    provenance: &'a Provenance,
    claim: &'a Claim,
}

/// The shape of a proof, as written.
#[derive(Serialize)]
struct Shape {
    precision: u32,
    trees: usize,
    nodes: usize,
    leaves: usize,
    depth: usize,
    rules: BTreeMap<&'static str, usize>,
}

impl Shape {
    /// The shape of a proof's trees; `None` for a counterexample.
    fn of(proof: &Proof) -> Option<Self> {
        match proof {
            Proof::Tree(tree) => {
                let TreeSize { nodes, leaves, depth, steps } = size_of(tree);
                let rules = steps.into_iter().collect();
                let (precision, trees) = (tree.precision, trees(&tree.nodes).len());
                Some(Shape { precision, trees, nodes, leaves, depth, rules })
            }
            Proof::Atlas(cells) => Some(Shape::of_atlas(cells)),
            _ => None,
        }
    }

    /// The trees of an atlas's certified cells together; of precisions, the greatest.
    fn of_atlas(cells: &[AtlasCell]) -> Self {
        let (mut precision, mut trees, mut size) = (0, 0, TreeSize::default());
        for cell in cells {
            if let AtlasCell::Certified(tree) = cell {
                trees += 1;
                precision = precision.max(tree.precision);
                size.add(size_of(tree));
            }
        }
        let TreeSize { nodes, leaves, depth, steps } = size;
        Shape { precision, trees, nodes, leaves, depth, rules: steps.into_iter().collect() }
    }
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let bytes = input::certificate(&arguments.certificate)?;
    let certificate = match read(&bytes) {
        Ok(certificate) => certificate,
        Err(reason) => {
            let hint = match is_paving(&bytes) {
                true => "; it is a paving, which `orthocert check` and `report` read".to_owned(),
                false => input::design_hint(&arguments.certificate),
            };
            return print::rejected(Format::Text, &arguments.certificate, &reason, &hint);
        }
    };
    let shown = shown(&certificate, bytes.len());
    print::told(arguments.format, &shown, || text(&certificate, bytes.len()))?;
    Ok(Status::Done)
}

fn shown(certificate: &Certificate, bytes: usize) -> Shown<'_> {
    let witness = match &certificate.proof {
        Proof::Witness(witness) => Some(witness),
        _ => None,
    };
    Shown {
        checked: false,
        stated_verdict: certificate.verdict,
        bytes,
        tree: Shape::of(&certificate.proof),
        witness,
        provenance: &certificate.provenance,
        claim: &certificate.claim,
    }
}

fn text(certificate: &Certificate, bytes: usize) -> String {
    let Provenance { tool, version } = &certificate.provenance;
    let mut out = format!("NOT CHECKED; the certificate says: {}\n\n", certificate.verdict);
    let statement = statement::statement(&certificate.claim, certificate.verdict);
    // The statement's first line says that it is proved, which is not known here.
    let (_, claim) = statement.split_once('\n').unwrap_or(("", &statement));
    out.push_str(&wrapped(claim));
    out.push('\n');
    if let Some(shape) = Shape::of(&certificate.proof) {
        let Shape { precision, trees, nodes, leaves, depth, rules } = shape;
        let trees = if trees == 1 { "a bisection tree".into() } else { format!("{trees} trees") };
        let (nodes, leaves) = (boxes(nodes), grouped(leaves as u64));
        let size = format!("{trees} of {nodes}, {leaves} of them leaves, depth {depth}");
        labelled(&mut out, "proof", &format!("{size}, {precision} bits"));
        let uses = rules.iter().map(|(rule, uses)| format!("{rule} {uses}"));
        labelled(&mut out, "rules used", &uses.collect::<Vec<_>>().join(", "));
    }
    if let Proof::Atlas(cells) = &certificate.proof {
        let count = |wanted: fn(&AtlasCell) -> bool| {
            grouped(cells.iter().filter(|cell| wanted(cell)).count() as u64)
        };
        let text = format!(
            "an atlas of {} certified, {} refuted and {} undecided cells",
            count(|cell| matches!(cell, AtlasCell::Certified(_))),
            count(|cell| matches!(cell, AtlasCell::Refuted(_))),
            count(|cell| matches!(cell, AtlasCell::Undecided))
        );
        labelled(&mut out, "map", &text);
    }
    if let Some(found) = counterexample(certificate) {
        let point: Vec<String> = found.point.iter().map(exact).collect();
        let (point, value) = (point.join(", "), found.value);
        let text = format!("a counterexample at P = ({point}) to {}: {value}", found.violated);
        labelled(&mut out, "proof", &text);
    }
    labelled(&mut out, "size", &format!("{} bytes", grouped(bytes as u64)));
    labelled(&mut out, "written by", &format!("{tool} {version}"));
    wrap(&mut out, "\"orthocert check\" re-proves it.", 2);
    out
}
