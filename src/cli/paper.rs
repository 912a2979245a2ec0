//! `orthocert paper`.

use super::{certify, print, Failure, Format, Status};
use crate::exact::decimal::{rounded, Toward};
use crate::files::output;
use crate::questions::paper::{findings, Agreement, Basis, Finding, Value};
use crate::report::text::{labelled, verbatim};
use crate::report::CertificateFile;
use serde::Serialize;
use std::fmt::Write;
use std::path::PathBuf;

/// Significant digits of every decimal.
const DIGITS: u32 = 15;

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Write the certificates into this folder, which exists
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    /// The form of the answer
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// A finding for scripts.
#[derive(Serialize)]
struct Row {
    id: &'static str,
    place: &'static str,
    paper_says: &'static str,
    proved: &'static str,
    agreement: &'static str,
    values: Vec<Enclosed>,
    /// The argument, where there is no certificate.
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<&'static str>,
    /// Names of the certificates accepted in this run.
    certificates: Vec<&'static str>,
    /// Where they were written.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    files: Vec<CertificateFile>,
}

/// A number between two proved decimals.
#[derive(Serialize)]
struct Enclosed {
    symbol: &'static str,
    exact: String,
    min: String,
    max: String,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    if let Some(folder) = &arguments.output {
        output::probe(&folder.join("paper-bounds.cert.json"))?;
    }
    let found = findings().map_err(|error| Failure::Input(format!("not established: {error}")))?;
    let rows: Vec<Row> =
        found.iter().map(|finding| row(finding, arguments)).collect::<Result<_, _>>()?;
    print::told(arguments.format, &serde_json::json!({ "claims": rows }), || text(&rows))?;
    Ok(Status::Done)
}

fn row(finding: &Finding, arguments: &Arguments) -> Result<Row, Failure> {
    let mut row = Row {
        id: finding.id,
        place: finding.place,
        paper_says: finding.says,
        proved: finding.proved,
        agreement: match finding.agreement {
            Agreement::Holds => "holds",
            Agreement::Corrected => "corrected",
            Agreement::Fails => "fails",
        },
        values: finding.values.iter().map(enclosed).collect(),
        reason: None,
        certificates: Vec::new(),
        files: Vec::new(),
    };
    match &finding.basis {
        Basis::Algebra(reason) => row.reason = Some(reason),
        Basis::Certificates(certificates) => {
            for (name, certificate) in certificates {
                row.certificates.push(name);
                if let Some(folder) = &arguments.output {
                    let path = folder.join(format!("{name}.cert.json"));
                    row.files.push(certify::write(Some(folder), &path, certificate)?);
                }
            }
        }
    }
    Ok(row)
}

fn enclosed(value: &Value) -> Enclosed {
    Enclosed {
        symbol: value.symbol,
        exact: value.exact.to_string(),
        min: rounded(&value.least, DIGITS, Toward::Below),
        max: rounded(&value.greatest, DIGITS, Toward::Above),
    }
}

fn text(rows: &[Row]) -> String {
    let mut out = "The paper's claims, paraphrased, and what is proved of each.\n\
         Values are proved to lie between their two decimals.\n"
        .to_owned();
    for row in rows {
        let Row { id, place, agreement, .. } = row;
        let _ = writeln!(out, "\n{:<9}  {id} ({place})", agreement.to_uppercase());
        labelled(&mut out, "paper", row.paper_says);
        labelled(&mut out, "proved", row.proved);
        for Enclosed { symbol, min, max, .. } in &row.values {
            labelled(&mut out, "value", &format!("{symbol} in [{min}, {max}]"));
        }
        match row.reason {
            Some(reason) => labelled(&mut out, "because", reason),
            None => {
                let certificates = row.certificates.join(", ");
                labelled(&mut out, "because", &format!("certificate {certificates}, accepted"));
            }
        }
        for file in &row.files {
            verbatim(&mut out, "written", &file.path);
        }
    }
    out
}
