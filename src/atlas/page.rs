//! The map as a page: one HTML file that needs nothing else.

use crate::escape::xml;
use std::fmt::Write;

const STYLE: &str = "body { font: 16px/1.45 sans-serif; max-width: 60em; margin: 2em auto; \
padding: 0 1em; color: #222 } svg { max-width: 100%; height: auto } \
pre { white-space: pre-wrap } @media (prefers-color-scheme: dark) { \
html { background: #0f1318 } body { color: #e6eaf0 } } td, th { text-align: left; padding: .15em 1.2em .15em 0 }";

/// What the lines of equal margin are.
const LINES: &str =
    "<p>Lines of equal margin, by sampling: by so much all bounds can be tightened \
                     together.</p>\n";

/// A page with a title, the picture, and what its lines are where it has some, a table of facts, and
/// the statement of the certificate.
pub fn page(
    title: &str,
    (svg, has_lines): (&str, bool),
    facts: &[(String, String)],
    statement: &str,
) -> String {
    let title = xml(title);
    let lines = if has_lines { LINES } else { "" };
    let mut out = format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>{title}</title>\n\
         <style>{STYLE}</style>\n<h1>{title}</h1>\n{svg}{lines}<table>\n"
    );
    for (name, value) in facts {
        let (name, value) = (xml(name), xml(value));
        let _ = writeln!(out, "<tr><th>{name}</th><td>{value}</td></tr>");
    }
    let _ = writeln!(
        out,
        "</table>\n<h2>What is proved</h2>\n<pre>{}</pre>",
        xml(statement.trim_end())
    );
    out.push_str("</html>\n");
    out
}
