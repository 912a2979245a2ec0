//! Certificates as files of the formal development in `proofs/rocq`.
//!
//! A file has the certificate as a value of the types of `kernel/Certificate.v`, and a theorem about real
//! numbers that mentions the claim and not the evidence. Rocq runs the verified checker on the
//! certificate, and accepts the theorem or does not: nothing here has to be trusted. What a reader has to
//! look at is the claim and the theorem in the file.

use orthocert_checker::certificate::{Certificate, Proof, Verdict};
use orthocert_kernel::number::Expression;
use std::fmt::{Display, Write};

mod claim;
mod proof;

/// Why a certificate is not exported.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// There is no theorem about it, in the words of `orthocert-verified`.
    #[error("{0} is not covered by the verified checker")]
    NotCovered(String),
    /// What it calls refuted it has a tree for, or it has a witness for what it calls certified.
    #[error("the verdict is not that of the proof")]
    Verdict,
}

type Exported<T> = Result<T, ExportError>;

fn not_covered<T>(what: impl Display) -> Exported<T> {
    Err(ExportError::NotCovered(what.to_string()))
}

const HEADER: &str = "\
(** Written by `orthocert export rocq`. What has to be read is the theorem at the end and the claim that it is about,
    which have the meaning that kernel/Certificate.v gives them; the evidence is not trusted, nor is the writer. *)

From Orthocert.kernel Require Import Notations.
Local Open Scope string_scope.
Local Open Scope written_scope.

";

/// The text of a Rocq file that states what the certificate claims, or that it is false, and proves it by
/// the certificate. Whether that is a proof, Rocq decides.
///
/// # Errors
/// If it is not of a kind that the verified checker covers, or has another verdict than its proof.
pub fn rocq(certificate: &Certificate) -> Exported<String> {
    let Certificate { claim, verdict, proof, provenance, format: _ } = certificate;
    let is_refuted = matches!(proof, Proof::Witness(_));
    let subject = claim::subject(claim)?;
    let written = proof::proof(proof, &subject)?;
    if is_refuted != (*verdict == Verdict::Refuted) {
        return Err(ExportError::Verdict);
    }
    let mut out = HEADER.to_owned();
    for (name, is, x) in &subject.arguments {
        let _ = writeln!(out, "Definition {name} : {is} := {x}.");
    }
    if let Some((is, of)) = subject.claim() {
        let names = subject.arguments.iter().map(|(name, _, _)| *name);
        let names = names.collect::<Vec<_>>().join(" ");
        let _ = writeln!(out, "Definition the_claim : {is} := {of} {names}.");
    }
    let [tool, version] = [&provenance.tool, &provenance.version].map(|label| quoted(label));
    let _ = write!(
        out,
        "\n(** The evidence. *)\nLocal Open Scope nat_scope.\nDefinition the_proof : proof := {written}.\n\
         Definition the_certificate : certificate := Certificate ({}) the_proof {tool} {version}.\n\n\
         Lemma accepted : accept the_certificate = true.\n\
         Proof. vm_cast_no_check (eq_refl true). Qed.\n\n\
         Theorem {} :\n  {}.\nProof. exact (accept_sound the_certificate accepted). Qed.\n",
        subject.term(),
        if is_refuted { "refuted" } else { "certified" },
        subject.means(proof)
    );
    Ok(out)
}

/// `f x y`
fn apply<const N: usize>(constructor: &str, arguments: [String; N]) -> String {
    format!("{constructor} {}", arguments.join(" "))
}

fn list(all: impl IntoIterator<Item = String>) -> String {
    format!("[{}]", all.into_iter().collect::<Vec<_>>().join("; "))
}

/// A list, one a line.
fn lines(all: impl IntoIterator<Item = String>) -> String {
    let all: Vec<_> = all.into_iter().collect();
    if all.is_empty() {
        "[]".to_owned()
    } else {
        format!("[\n  {}]", all.join(";\n  "))
    }
}

fn row(row: &[i64]) -> String {
    list(row.iter().map(i64::to_string)) + "%Z"
}

fn matrix(rows: &[Vec<i64>]) -> String {
    list(rows.iter().map(|row| list(row.iter().map(i64::to_string)))) + "%Z"
}

fn optional(x: Option<String>) -> String {
    let Some(x) = x else { return "None".to_owned() };
    let is_one = !x.contains(' ') || x.starts_with(['(', '[']);
    if is_one {
        format!("(Some {x})")
    } else {
        format!("(Some ({x}))")
    }
}

/// In Rocq nothing but a quotation mark ends a string.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}

/// An expression as its own text, which kernel/Notations.v reads, with `name` of the strings that are its
/// names; in parentheses, unless it is digits.
fn text(x: &Expression, name: impl Fn(String) -> String) -> String {
    let text = x.to_string();
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '.';
    let mut out = String::new();
    let mut rest = text.as_str();
    while let Some(first) = rest.chars().next() {
        let end = rest.find(|c| !is_word(c)).unwrap_or(rest.len()).max(first.len_utf8());
        let (word, after) = rest.split_at(end);
        match word {
            "-" if out.ends_with(['+', '-', '*', '/']) => out.push_str(" -"),
            word if word != "sqrt" && first.is_ascii_alphabetic() => {
                out.push_str(&name(quoted(word)))
            }
            word => out.push_str(word),
        }
        rest = after;
    }
    if out.chars().all(is_word) {
        out
    } else {
        format!("({out})")
    }
}
