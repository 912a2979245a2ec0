//! The map as a page: one HTML file that needs nothing else.

use crate::report::escape::xml;
use std::fmt::Write;

/// That of certificates' pages, with what a map needs of its own.
const STYLE: &str = concat!(
    include_str!("../page/page.css"),
    "#map svg { max-width: 100%; height: auto; background: #fff; border-radius: 6px }\n"
);

/// What the lines of equal margin are.
const LINES: &str =
    "<p>Lines of equal margin, by sampling: by so much all bounds can be tightened \
                     together.</p>\n";

/// A page with a title, the picture, and what its lines are where it has some, a table of facts, and
/// the statement of the certificate as HTML.
pub fn page(
    title: &str,
    (svg, has_lines): (&str, bool),
    facts: &[(String, String)],
    statement: &str,
) -> String {
    let title = xml(title);
    let lines = if has_lines { LINES } else { "" };
    let mut out = format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n\
         <style>{STYLE}</style>\n<header><p class=\"kicker\">Workspace verification</p>\
         <h1>{title}</h1></header>\n<main><section><dl class=\"signed\">"
    );
    for (name, value) in facts {
        let (name, value) = (xml(name), xml(value));
        let _ = write!(out, "<dt>{name}</dt><dd>{value}</dd>");
    }
    let _ = writeln!(
        out,
        "</dl></section>\n<section id=\"map\">{svg}{lines}</section>\n\
         <section><h2>What is proved</h2>\n{statement}</section></main>\n</html>",
    );
    out
}
