//! JUnit XML: one test case a design.
//!
//! A refuted design is a `failure`; bad input, an undecided design and trouble of the tool are an
//! `error`; `skipped` is what was not run. The document has the elements and attributes that the
//! schemas of Maven Surefire and of Jenkins' xUnit plugin have in common, in their order.

use super::{Batch, Ending, Entry};
use crate::files::shown::Shown;
use crate::report::escape::{attribute, xml};
use std::fmt::Write;
use std::path::Path;

/// The report.
pub fn junit(batch: &Batch) -> String {
    let count = |kinds: &[Ending]| {
        batch.designs.iter().filter(|entry| kinds.contains(&entry.verdict)).count()
    };
    let mut out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n".to_owned();
    let _ = writeln!(
        out,
        "<testsuite name=\"orthocert\" time=\"{:.3}\" tests=\"{}\" errors=\"{}\" skipped=\"{}\" \
         failures=\"{}\">",
        batch.seconds,
        batch.designs.len(),
        count(&[Ending::Undecided, Ending::BadInput, Ending::Rejected, Ending::NotFinished]),
        count(&[Ending::NotRun]),
        count(&[Ending::Refuted]),
    );
    for entry in &batch.designs {
        case(&mut out, entry);
    }
    out.push_str("</testsuite>\n");
    out
}

fn case(out: &mut String, entry: &Entry) {
    let path = Path::new(&entry.design);
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
    let folder = path.parent().map(|folder| folder.to_string_lossy().into_owned());
    let folder = folder.filter(|folder| !folder.is_empty()).unwrap_or_else(|| ".".to_owned());
    let _ = writeln!(
        out,
        "  <testcase name=\"{}\" classname=\"{}\" time=\"{:.3}\">",
        attribute(&name.unwrap_or_else(|| entry.design.clone())),
        attribute(&folder),
        entry.seconds
    );
    let message = attribute(&entry.remark());
    let kind = entry.verdict.word().replace(' ', "-");
    let body = xml(&explanation(entry));
    let _ = match entry.verdict {
        Ending::Certified => Ok(()),
        Ending::Refuted => {
            writeln!(out, "    <failure message=\"{message}\" type=\"{kind}\">{body}</failure>")
        }
        Ending::NotRun => writeln!(out, "    <skipped message=\"{message}\"/>"),
        _ => writeln!(out, "    <error message=\"{message}\" type=\"{kind}\">{body}</error>"),
    };
    let _ = writeln!(out, "    <system-out>{}</system-out>", xml(&facts(entry)));
    out.push_str("  </testcase>\n");
}

/// The whole of what an entry says of a verdict other than "certified".
fn explanation(entry: &Entry) -> String {
    let Some(found) = &entry.counterexample else {
        return entry.message.clone().unwrap_or_default();
    };
    let point: Vec<String> = found.point.iter().map(ToString::to_string).collect();
    let point = point.join(", ");
    let mut text = format!("{}\n{}\nat P = ({point})", found.violated, found.value);
    for near in &found.bodies {
        let _ = write!(text, "\n{near}");
    }
    for setting in &found.machine {
        let leg = setting.leg.map(|leg| format!("leg {leg} ")).unwrap_or_default();
        let _ = write!(text, "\n{leg}{} = {}", setting.parameter, setting.value);
    }
    text
}

/// The title, the requirements and the certificate.
fn facts(entry: &Entry) -> String {
    let mut text = String::new();
    if let Some(title) = &entry.title {
        let _ = writeln!(text, "{}", Shown(title));
    }
    for requirement in &entry.requirements {
        let _ = writeln!(text, "{}: {}", requirement.rule, requirement.demands);
    }
    if let Some(file) = &entry.certificate {
        let how = if entry.cached { "re-checked" } else { "written" };
        let _ = writeln!(text, "certificate {} ({how}), sha256 {}", Shown(&file.path), file.sha256);
    }
    text
}
