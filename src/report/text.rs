//! Reports for people: the verdict first, then the table, within 80 columns.

use super::facts::{DETERMINANT, RADICAND};
use super::place::{angle_of, in_degrees, placed, point_text, pose_text, turn_text, FreeParameter};
use super::remains::OpenRequirement;
use super::{
    machine_of_witness, CertificateFile, Counterexample, EarlierFile, Margin, Outcome,
    PostulateReport, Remains, Report, Row, Size,
};
use crate::exact::decimal::{self, boxes, counted, exact, grouped, significant, Toward};
use crate::exact::Exact;
use crate::files::shown::Shown;
use crate::search::solver::value::{in_length, listed, with_unit, Coordinates};
use num_rational::BigRational;
use orthocert_checker::certificate::Verdict;
use std::fmt::Write;

/// Columns of a line.
pub const WIDTH: usize = 80;
/// Significant digits of values found.
const VALUE_DIGITS: u32 = 9;
/// Significant digits of places.
const PLACE_DIGITS: u32 = 6;
/// Significant digits of how the middle of a box is turned.
const TURN_DIGITS: u32 = 4;
/// Longest name of an open requirement that stands on a line with its boxes.
const OPEN_NAME: usize = 44;
/// Longest exact coordinate that stands on a line with others.
const SHORT_COORDINATE: usize = 20;

/// How verdicts are set off on a terminal; the words never depend on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// No colour.
    Plain,
    /// ANSI colours.
    Colour,
}

impl Style {
    /// What the words are set off with.
    pub const MARKS: [&str; 4] = ["\x1b[1;31m", "\x1b[1;32m", "\x1b[1;33m", "\x1b[0m"];

    /// The word of a verdict.
    pub fn verdict(self, outcome: Outcome) -> String {
        let (word, colour) = match outcome {
            Outcome::Decided(Verdict::Certified) => ("CERTIFIED", 32),
            Outcome::Decided(Verdict::Refuted) => ("REFUTED", 31),
            Outcome::Undecided => ("UNDECIDED", 33),
        };
        match self {
            Style::Plain => word.to_owned(),
            Style::Colour => format!("\x1b[1;{colour}m{word}\x1b[0m"),
        }
    }
}

/// The first line of a report.
pub fn headline(report: &Report, style: Style) -> String {
    let name = report.title.as_deref().or(report.design.as_deref()).unwrap_or("design");
    headline_of(report.verdict, name, style)
}

/// A verdict and what it is about, on one line.
pub fn headline_of(verdict: Outcome, subject: &str, style: Style) -> String {
    let room = WIDTH - "UNDECIDED  ".len();
    let subject: String = Shown(subject).to_string().chars().take(room).collect();
    format!("{}  {subject}", style.verdict(verdict))
}

/// The first line of a report about the postulate.
pub fn postulate_headline(report: &PostulateReport, style: Style) -> String {
    headline_of(report.verdict, &report.subject, style)
}

/// The whole report about the postulate.
pub fn postulate(report: &PostulateReport, style: Style) -> String {
    let mut out = postulate_headline(report, style);
    out.push('\n');
    let meaning = match report.verdict {
        Outcome::Decided(_) => {
            "If the bounds 1/psi_max <= psi_i <= psi_max hold at Q1 and Q2, as they do by \
             construction, they hold on the whole closed cube [q1, q2]^3, free of singularities. \
             The proof was accepted by the exact checker."
        }
        Outcome::Undecided => "No proof was found.",
    };
    wrap(&mut out, meaning, 0);
    out.push('\n');
    if let Some(reason) = &report.undecided {
        labelled(&mut out, "why", reason);
        labelled(&mut out, "would help", "a larger budget: --max-boxes, --timeout");
    }
    effort(&mut out, report.proof.as_ref(), Some(report.boxes_tried), report.seconds);
    match &report.certificate {
        Some(file) => certificate(&mut out, file),
        None if report.undecided.is_some() => labelled(&mut out, "certificate", NONE_UNDECIDED),
        None => labelled(&mut out, "certificate", "not written; -o CERT.json writes it"),
    }
    if let Some(earlier) = &report.earlier_certificate {
        earlier_file(&mut out, earlier);
    }
    out
}

/// The whole report; all that is known where `verbose`, else what answers the question.
pub fn report(report: &Report, style: Style, verbose: bool) -> String {
    let mut out = headline(report, style);
    out.push('\n');
    let toleranced = report.requirements.iter().any(|row| !row.machine.is_empty());
    meaning(&mut out, report.verdict, toleranced);
    if let Some(counterexample) = &report.counterexample {
        describe_counterexample(&mut out, counterexample, &report.coordinates, verbose);
    }
    if let Some(hint) = &report.hint {
        labelled(&mut out, "hint", hint);
    }
    if !report.notes.is_empty() {
        out.push('\n');
    }
    report.notes.iter().for_each(|note| labelled(&mut out, "note", note));
    if let Some(remains) = &report.undecided {
        describe_remains(&mut out, remains, &report.coordinates, (verbose, toleranced));
    }
    out.push('\n');
    table(&mut out, report, verbose);
    if !report.margins.is_empty() {
        labelled(&mut out, "certified", &margins(&report.margins, report.length_unit));
    }
    out.push('\n');
    let tried = (!report.cached).then_some(report.boxes_tried);
    effort(&mut out, report.proof.as_ref(), tried, report.seconds);
    files(&mut out, report);
    out
}

/// The certified margins, those of one bound together.
fn margins(margins: &[Margin], length: Option<&str>) -> String {
    let mut told: Vec<(&Margin, Vec<&str>)> = Vec::new();
    for margin in margins {
        let same = |(other, _): &&mut (&Margin, Vec<&str>)| {
            let place = (other.relation, other.unit, &other.bound);
            place == (margin.relation, margin.unit, &margin.bound)
        };
        match told.iter_mut().find(same) {
            Some((_, names)) => names.push(&margin.name),
            None => told.push((margin, vec![&margin.name])),
        }
    }
    let text = |(margin, names): &(&Margin, Vec<&str>)| {
        let name = with_unit(&listed(names), margin.unit);
        let name = in_length(&name, margin.unit, length);
        format!("{name} {} {}", margin.relation, exact(&margin.bound))
    };
    told.iter().map(text).collect::<Vec<_>>().join("; ")
}

/// What a verdict means, in words.
pub fn meaning(out: &mut String, verdict: Outcome, toleranced: bool) {
    let meaning = match verdict {
        Outcome::Decided(Verdict::Certified) if toleranced => {
            "Every requirement holds at every point of the workspace, for every machine within the \
             tolerances. The proof was accepted by the exact checker."
        }
        Outcome::Decided(Verdict::Certified) => {
            "Every requirement holds at every point of the workspace. The proof was accepted by the \
             exact checker."
        }
        Outcome::Decided(Verdict::Refuted) => {
            "A requirement fails: the counterexample was accepted by the exact checker."
        }
        Outcome::Undecided => "Neither a proof nor a counterexample was found.",
    };
    wrap(out, meaning, 0);
}

/// The rows that are shown, each with its name: all of them, or of what is demanded of every leg alike
/// the leg with the worst value.
fn shown(rows: &[Row], verbose: bool) -> Vec<(String, &Row)> {
    let mut shown: Vec<(&Row, usize)> = Vec::new();
    for row in rows {
        let alike = |(other, _): &&mut (&Row, usize)| {
            row.of_all.is_some() && (&other.of_all, &other.bound) == (&row.of_all, &row.bound)
        };
        match shown.iter_mut().find(alike).filter(|_| !verbose) {
            Some((worst, legs)) => {
                *legs += 1;
                if row.is_worse_than(worst) {
                    *worst = row;
                }
            }
            None => shown.push((row, 1)),
        }
    }
    let name = |(row, legs): (&'_ Row, usize)| match legs {
        1 => row.requirement.clone(),
        legs => match row.requirement.split_once(", ") {
            Some((name, unit)) => format!("{name} of {legs}, {unit}"),
            None => format!("{} of {legs}", row.requirement),
        },
    };
    shown.into_iter().map(|(row, legs)| (name((row, legs)), row)).collect()
}

/// The requirements and the worst values found.
fn table(out: &mut String, report: &Report, verbose: bool) {
    let Report { requirements: rows, coordinates, length_unit: length, .. } = report;
    let names = coordinates.positions();
    let unit = length.filter(|_| !names.is_empty()).map(|unit| format!(", {unit}"));
    let place = match names.is_empty() {
        true => "at".to_owned(),
        false => format!("at P = ({}){}", names.join(", "), unit.unwrap_or_default()),
    };
    let head = ["requirement".to_owned(), "bound".to_owned(), "worst found".to_owned(), place];
    let is_of_two = |row: &Row| row.relation == "holds" && !row.seems_violated;
    let cells = |(name, row): &(String, &Row)| {
        let value = match row.worst_found {
            Some(value) => significant(value, VALUE_DIGITS),
            // It is of two points: where none are found, sampling tells nothing.
            None if is_of_two(row) => "-".to_owned(),
            None => "out of reach".to_owned(),
        };
        let mark = if row.seems_violated { "! " } else { "" };
        let requirement = format!("{mark}{}", in_length(name, row.unit, *length));
        let place = match (names.len(), turn_text(&row.at, coordinates, PLACE_DIGITS)) {
            _ if is_of_two(row) => String::new(),
            (0, Some(turn)) => turn,
            (_, None) => point_text(&row.at, PLACE_DIGITS),
            (places, Some(turn)) => {
                let place = row.at.get(..places).unwrap_or(&row.at);
                format!("{}, {turn}", point_text(place, PLACE_DIGITS))
            }
        };
        [requirement, row.bound_text.clone(), value, place]
    };
    let rows_shown = shown(rows, verbose);
    let body: Vec<[String; 4]> = rows_shown.iter().map(cells).collect();
    let width = |column: usize| {
        body.iter().chain([&head]).map(|row| row[column].chars().count()).max().unwrap_or(0)
    };
    let widths = [width(0), width(1), width(2)];
    let mut line = |[a, b, c, d]: &[String; 4]| {
        let [wa, wb, wc] = widths;
        let values = format!("  {a:wa$}  {b:wb$}  {c:wc$}");
        // A place that does not fit stands on a line of its own.
        let text = match values.chars().count() + 2 + d.chars().count() {
            0..=WIDTH => format!("{values}  {d}"),
            _ => format!("{}\n      {}", values.trim_end(), placed(d)),
        };
        let _ = writeln!(out, "{text}");
    };
    line(&head);
    for row in &body {
        line(row);
    }
    if verbose {
        machines(out, rows);
    } else if rows.iter().any(|row| !row.machine.is_empty()) {
        out.push_str(
            "  each found for a machine at the ends of its tolerances: --verbose names it\n",
        );
    }
    if rows.iter().any(|row| row.requirement == RADICAND) {
        out.push_str("  least radicand: 0 where reach ends; |det M|: 0 at a singularity\n");
    }
    let is_negative = |row: &Row| row.worst_found.is_some_and(|value| value < 0.0);
    if rows.iter().any(|row| row.requirement == DETERMINANT && is_negative(row)) {
        out.push_str("  |det M|: negative where det M has another sign than at the centre\n");
    }
    if rows.iter().any(|row| row.seems_violated) {
        out.push_str("  ! the value found is beyond its bound\n");
    }
}

/// The machines at which the worst values were found, where there are tolerances.
fn machines(out: &mut String, rows: &[Row]) {
    let mut told: Vec<(String, Vec<&str>)> = Vec::new();
    for row in rows.iter().filter(|row| !row.machine.is_empty()) {
        let machine = machine(&row.machine);
        match told.iter_mut().find(|(other, _)| *other == machine) {
            Some((_, requirements)) => requirements.push(&row.requirement),
            None => told.push((machine, vec![&row.requirement])),
        }
    }
    for (machine, requirements) in told {
        wrap(out, &format!("{}: with {machine}", requirements.join(", ")), 2);
    }
}

/// The parameters of a machine, those of one name together: `length 310, 310.1, 310.2 of legs 1,
/// 2, 3`.
pub fn machine(parameters: &[FreeParameter]) -> String {
    let mut names: Vec<&str> = Vec::new();
    for FreeParameter { parameter, .. } in parameters {
        if !names.contains(&parameter.as_str()) {
            names.push(parameter);
        }
    }
    let one = |name: &&str| {
        let same = || parameters.iter().filter(|p| p.parameter == *name);
        let values: Vec<String> = same().map(|p| significant(p.value, VALUE_DIGITS)).collect();
        let legs: Vec<String> = same().filter_map(|p| Some(p.leg?.to_string())).collect();
        let of = match legs.len() {
            0 => String::new(),
            1 => format!(" of leg {}", legs.join(", ")),
            _ => format!(" of legs {}", legs.join(", ")),
        };
        format!("{name} {}{of}", values.join(", "))
    };
    names.iter().map(one).collect::<Vec<_>>().join("; ")
}

/// A refutation's witness.
pub fn describe_counterexample(
    out: &mut String,
    found: &Counterexample,
    coordinates: &Coordinates,
    verbose: bool,
) {
    out.push('\n');
    labelled(out, "violated", &found.violated);
    labelled(out, "value there", &found.value);
    for (label, near) in ["of", "and"].into_iter().zip(&found.bodies) {
        labelled(out, label, &near.to_string());
    }
    point(out, "at P", &found.point, coordinates, verbose);
    if let Some(other) = &found.other_point {
        point(out, "and at P'", other, coordinates, verbose);
    }
    machine_of_witness(out, &found.machine, verbose);
    let tuple = |v: &Vec<i64>| v.iter().map(i64::to_string).collect::<Vec<_>>().join(", ");
    let directions: Vec<String> =
        found.directions.iter().map(|v| format!("({})", tuple(v))).collect();
    if !directions.is_empty() && verbose {
        labelled(out, "moving along", &directions.join(" and "));
    }
}

/// A point of a witness: exact, but for how it is turned, and for what is long unless all is told.
fn point(out: &mut String, label: &str, point: &[Exact], coordinates: &Coordinates, verbose: bool) {
    let values: Vec<String> = point.iter().map(exact).collect();
    let approximate: Vec<f64> =
        point.iter().map(|x| decimal::approximate(x).unwrap_or(f64::NAN)).collect();
    let turn = turn_text(&approximate, coordinates, PLACE_DIGITS);
    let short = values.iter().all(|value| value.len() <= SHORT_COORDINATE);
    match turn {
        None if short => labelled(out, label, &format!("({})", values.join(", "))),
        Some(_) if !verbose => {
            labelled(out, label, &pose_text(&approximate, coordinates, PLACE_DIGITS));
        }
        _ if !verbose => {
            let text: Vec<String> = point.iter().map(decimal::readable).collect();
            labelled(out, label, &format!("({})", text.join(", ")));
        }
        turn => {
            for (name, value) in coordinates.iter().zip(&values) {
                labelled(out, &format!("{label}, {name}"), value);
            }
            if let Some(turn) = turn {
                labelled(out, "", &turn);
            }
        }
    }
}

/// Regions that are told unless all are asked for.
const REGIONS: usize = 2;

fn describe_remains(
    out: &mut String,
    remains: &Remains,
    coordinates: &Coordinates,
    (verbose, toleranced): (bool, bool),
) {
    let number = |x: f64| significant(x, 3);
    out.push('\n');
    labelled(out, "why", &remains.reason);
    if remains.boxes == 0 {
        return;
    }
    let regions = counted(remains.region_count, "region", "regions");
    // Of orientations, too, it would have no unit.
    let volume = match coordinates.turns() {
        [] => format!("volume {}, ", number(remains.volume)),
        _ => String::new(),
    };
    let (boxes_there, share) = (boxes(remains.boxes), percent(remains.share));
    // Orientations are a part of the box around them.
    let whole = match coordinates.are_of_axis() {
        true => "the box around the workspace",
        false => "the workspace",
    };
    labelled(out, "open", &format!("{boxes_there} in {regions}: {volume}{share} of {whole}"));
    if let Some(worst) = &remains.worst_box {
        let margin = number(worst.margin);
        let machine = if toleranced { ", of the middle machine" } else { "" };
        let text =
            format!("{}: relative margin {margin} at its centre{machine}", worst.requirement);
        labelled(out, "worst box", &text);
        extent(out, &worst.min, &worst.max, coordinates);
    }
    out.push_str("\n  regions (neighbouring boxes merged)\n");
    let told = if verbose { remains.regions.len() } else { REGIONS };
    for region in remains.regions.iter().take(told) {
        let text = format!("{}, {} of {whole}", boxes(region.boxes), percent(region.share));
        wrap(out, &text, 4);
        extent(out, &region.min, &region.max, coordinates);
    }
    if coordinates.are_of_axis() {
        let text = "c_x, c_y, c_z: of a turn by theta, tan(theta/2) times its axis";
        wrap(out, text, 4);
    }
    let hidden = remains.region_count - remains.regions.len().min(told);
    if hidden > 0 {
        let how = if verbose { "" } else { ": --verbose" };
        let _ = writeln!(out, "    and {} smaller ones{how}", grouped(hidden as u64));
    }
    let mut groups: Vec<Vec<&OpenRequirement>> = Vec::new();
    for open in &remains.open {
        let alike = |group: &&mut Vec<&OpenRequirement>| {
            (group[0].reason, group[0].help) == (open.reason, open.help)
        };
        match groups.iter_mut().find(alike) {
            Some(group) => group.push(open),
            None => groups.push(vec![open]),
        }
    }
    for group in groups {
        out.push('\n');
        open_rows(out, &group, whole);
        wrap(out, group[0].reason, 4);
        wrap(out, &format!("what would help: {}", group[0].help), 4);
    }
}

/// Requirements with the boxes on which they are open. A name that does not fit stands on lines of its own.
fn open_rows(out: &mut String, open: &[&OpenRequirement], whole: &str) {
    let name = |own: &&OpenRequirement| format!("{}: {}", own.obligation, own.requirement);
    let names: Vec<String> = open.iter().map(name).collect();
    let fits = |name: &&str| name.chars().count() <= OPEN_NAME;
    let width = names.iter().map(String::as_str).filter(fits).chain(["requirement"]);
    let width = width.map(|name| name.chars().count()).max().unwrap_or(0);
    let mut line = |name: &str, boxes: &str, share: &str| {
        let mut name = name;
        if name.chars().count() > width {
            wrap(out, name, 2);
            name = "";
        }
        let _ = writeln!(out, "  {name:width$}  {boxes:15}  {share}");
    };
    line("requirement", "open on", &format!("of {whole}"));
    for (own, name) in open.iter().zip(&names) {
        line(name, &boxes(own.boxes), &percent(own.share));
    }
}

/// The ends of a box, in as many digits as tell them apart: angles in degrees, and where each coordinate is of the
/// axis of a rotation, also how its middle is turned.
fn extent(out: &mut String, min: &[f64], max: &[f64], coordinates: &Coordinates) {
    for (k, axis) in coordinates.iter().enumerate() {
        let (name, [min, max]) = match angle_of(axis) {
            Some(angle) => (format!("{angle}, deg"), [min[k], max[k]].map(in_degrees)),
            None => (axis.clone(), [min[k], max[k]]),
        };
        let ends = |digits| (significant(min, digits), significant(max, digits));
        let apart = (PLACE_DIGITS..=17).map(ends).find(|(min, max)| min != max);
        let (min, max) = apart.unwrap_or_else(|| ends(PLACE_DIGITS));
        let _ = writeln!(out, "      {name}  {min} .. {max}");
    }
    if coordinates.are_of_axis() {
        let middle: Vec<f64> = min.iter().zip(max).map(|(min, max)| (min + max) / 2.0).collect();
        if let Some(turn) = turn_text(&middle, coordinates, TURN_DIGITS) {
            let _ = writeln!(out, "      its middle: {turn}");
        }
    }
}

/// The proof's size and the boxes tried for it; without a number of them, nothing was searched for.
fn effort(out: &mut String, proof: Option<&Size>, tried: Option<usize>, seconds: f64) {
    let tried = match tried {
        Some(tried) => format!("{} tried", boxes(tried)),
        None => "re-checked, not searched for".to_owned(),
    };
    let time = duration(seconds);
    let Some(Size { leaves, nodes, depth, precision, .. }) = proof else {
        return labelled(out, "effort", &format!("{tried}, {time}"));
    };
    let (leaves, nodes) = (counted(*leaves, "leaf", "leaves"), boxes(*nodes));
    let size = format!("{leaves} of {nodes}, depth {depth}, {precision} bits");
    labelled(out, "proof", &format!("{size}; {tried}, {time}"));
}

/// What stands for the certificate of an undecided claim.
const NONE_UNDECIDED: &str = "none is written without a verdict";

/// What is said of a certificate that was not written by this run.
const CACHED: &str =
    "was there, about this very claim, and was re-checked exactly; --reprove proves anew";

fn files(out: &mut String, report: &Report) {
    match &report.certificate {
        Some(file) => certificate(out, file),
        None => labelled(out, "certificate", NONE_UNDECIDED),
    }
    if report.cached {
        labelled(out, "", CACHED);
    }
    if let Some(earlier) = &report.earlier_certificate {
        earlier_file(out, earlier);
    }
}

fn certificate(out: &mut String, file: &CertificateFile) {
    file_line(out, file);
    labelled(out, "sha256", &file.sha256);
}

/// The line of a certificate that was written.
pub fn file_line(out: &mut String, file: &CertificateFile) {
    let bytes = grouped(file.bytes as u64);
    verbatim(out, "certificate", &format!("{} ({bytes} bytes)", file.path));
}

fn earlier_file(out: &mut String, earlier: &EarlierFile) {
    let says = if earlier.same_claim {
        "was there before this run and stays; it is about this very claim"
    } else {
        "was there before this run and stays; it is NOT about this claim"
    };
    verbatim(out, "earlier file", &earlier.path);
    labelled(out, "", says);
}

/// An undecided share as a percentage, rounded up.
fn percent(share: f64) -> String {
    BigRational::from_float(share)
        .map_or_else(String::new, |share| decimal::percent(&share, 3, Toward::Above))
}

/// A duration in the unit in which it is readable.
pub fn duration(seconds: f64) -> String {
    if seconds < 1.0 {
        format!("{} ms", significant(1e3 * seconds, 2))
    } else {
        format!("{} s", significant(seconds, 3))
    }
}

/// Width of the labels' column.
const LABEL: usize = 13;

/// A label and a text beside it, wrapped.
pub fn labelled(out: &mut String, label: &str, text: &str) {
    let label = format!("  {label:LABEL$} ");
    let mut body = String::new();
    wrap(&mut body, text, label.chars().count());
    let rest: String = body.chars().skip(label.chars().count()).collect();
    out.push_str(&label);
    out.push_str(&rest);
}

/// A label and a text beside it as it is, such as a path.
pub fn verbatim(out: &mut String, label: &str, text: &str) {
    let _ = writeln!(out, "  {label:LABEL$} {}", Shown(text));
}

/// Appends `text` in lines of at most [`WIDTH`] columns, each indented; a longer word stands alone.
pub fn wrap(out: &mut String, text: &str, indent: usize) {
    let margin = " ".repeat(indent);
    let mut column = 0;
    for word in text.split_whitespace() {
        let width = word.chars().count();
        if column > 0 && column + 1 + width <= WIDTH {
            out.push(' ');
            column += 1 + width;
        } else {
            if column > 0 {
                out.push('\n');
            }
            out.push_str(&margin);
            column = indent + width;
        }
        out.push_str(word);
    }
    out.push('\n');
}
