//! What commands print with `--format json` is as `orthocert schema` says.

use crate::support::Folder;
use serde_json::{json, Value};

const DESIGNS: [&str; 6] = [
    "orthoglide-312.toml",
    "orthoglide-310.toml",
    "orthoglide-tie.toml",
    "orthoglide-joint-range.toml",
    "rotary-delta-angle-refuted.toml",
    "star-singular.toml",
];

/// A definition of the schema, the arguments of a command, and its exit code, in order: later ones
/// read what earlier ones write.
const COMMANDS: &[(&str, &[&str], i32)] = &[
    ("verify", &["verify", "orthoglide-312.toml"], 0),
    ("verify", &["verify", "orthoglide-310.toml"], 1),
    ("verify", &["verify"], 0),
    ("verify", &["verify", "orthoglide-tie.toml", "--max-boxes", "50"], 3),
    ("verify", &["verify", "orthoglide-joint-range.toml"], 0),
    ("verify", &["verify", "rotary-delta-angle-refuted.toml"], 1),
    ("verify_many", &["verify", "orthoglide-312.toml", "bad.toml", "--out", "out"], 2),
    ("check", &["check", "orthoglide-312.cert.json"], 0),
    ("check_rejected", &["check", "bad.toml"], 5),
    ("check_folder", &["check", "out", "--designs", "."], 5),
    ("show", &["show", "orthoglide-310.cert.json"], 0),
    ("report", &["report", "orthoglide-312.cert.json", "--svg", "figures"], 0),
    ("bounds", &["bounds", "orthoglide-312.toml", "--relative", "0.01", "-o", "."], 0),
    ("bounds", &["bounds", "star-singular.toml"], 3),
    ("postulate", &["postulate", "--psi", "2", "-o", "postulate.cert.json"], 0),
    ("paper", &["paper"], 0),
    ("design", &["design", "--psi-max", "2", "--cube", "200"], 0),
    ("pave", &["pave", "region.toml", "--volume-gap", "0.5"], 0),
    ("unfinished", &["pave", "region.toml", "--timeout", "0", "-o", "none.paving"], 3),
    ("check_paving", &["check", "region.paving"], 0),
    (
        "split",
        &["split", "region.toml", "--pave", "--precision", "90", "--shards", "1", "--out", "job"],
        0,
    ),
    ("run_shard", &["run-shard", "job/shard-0001.json"], 0),
    ("submit", &["submit", "job", "--engine", "slurm", "--scripts-only", "-o", "later.paving"], 0),
    ("pave", &["pave", "region.toml", "--precision", "1000", "-o", "coarse.paving"], 0),
    ("postulate", &["postulate", "--all", "--timeout", "0", "-o", "none.json"], 3),
    ("largest_cube", &["largest-cube", "region.toml", "--side", "100"], 0),
    ("pave", &["merge", "job", "-o", "merged.paving"], 0),
    ("atlas", &["atlas", "map.toml"], 0),
    ("unfinished", &["atlas", "map.toml", "--timeout", "0", "-o", "none"], 3),
    ("report_paving", &["report", "region.paving"], 0),
    ("largest_cube", &["largest-cube", "region.toml", "--side", "250"], 1),
    ("tolerance", &["tolerance", "orthoglide-312.toml", "--on", "leg_length", "--gap", "0.5"], 0),
    ("tolerance", &["tolerance", "orthoglide-310.toml"], 1),
    ("tolerance", &["tolerance", "orthoglide-312.toml", "--each", "0"], 3),
    ("size", &["size", "orthoglide-312.toml", "--cube", "200", "--gap", "0.01"], 0),
    ("limit", &["limit", "orthoglide-312.toml", "mechanism.leg_length", "--gap", "0.01"], 0),
    ("limit", &["limit", "orthoglide-312.toml", "workspace.min.0", "--max-boxes", "1"], 3),
    ("limit", &["limit", "orthoglide-310.toml", "workspace.min.0", "--gap", "0.01"], 3),
    ("limit", &["limit", "toleranced.toml", "mechanism.leg_length", "--timeout", "0"], 3),
    ("limit", &["limit", "toleranced.toml", "mechanism.leg_length", "--gap", "0.5"], 0),
    ("summary", &["summary", "--speed", "1200", "--gap", "0.1"], 0),
    ("summary", &["summary", "orthoglide-310.toml", "--gap", "0.1"], 1),
    ("summary", &["summary", "orthoglide-tie.toml", "--max-boxes", "50"], 3),
    ("summary", &["summary", "accurate.toml", "--gap", "0.1"], 0),
    ("show", &["show", "postulate.cert.json"], 0),
];

#[test]
fn every_answer_is_as_the_schema_says() {
    let folder = Folder::with(&DESIGNS);
    folder.write("bad.toml", "no design");
    let design = String::from_utf8(folder.read("orthoglide-310.toml")).unwrap();
    let (machine, rest) = design.split_once("[workspace]").unwrap();
    let (_, requirements) = rest.split_once("[requirements]").unwrap();
    let region = "min = [-250, -250, -250]\nmax = [250, 250, 250]";
    folder.write(
        "region.toml",
        format!("{machine}[workspace]\n{region}\n[requirements]{requirements}"),
    );
    let toleranced = design.replace("leg_length = 310", "leg_length = \"312 ± 0.01\"");
    folder.write("toleranced.toml", &toleranced);
    let accurate =
        toleranced.replace("transmission =", "accuracy = { joint_error = 0.01, max = 1 } #");
    folder.write("accurate.toml", accurate);
    folder.write("map.toml", crate::atlas::widest(1).read("map.toml"));
    let text = folder.run(&["schema"]).exits(0).stdout;
    let schema: Value = serde_json::from_str(&text).unwrap();
    for (name, arguments, code) in COMMANDS.iter().copied() {
        let arguments = [arguments, &["--format", "json"]].concat();
        let answer = folder.run(&arguments).exits(code).stdout;
        let answer: Value = serde_json::from_str(&answer).unwrap();
        let mut one = schema.clone();
        one["$ref"] = json!(format!("#/$defs/{name}"));
        let validator = jsonschema::draft202012::new(&one).unwrap();
        let objection = validator.iter_errors(&answer).next();
        let objection =
            objection.map(|error| format!("at {}: {error:.300}", error.instance_path()));
        assert_eq!(objection, None, "{name}: {arguments:?}");
        // What is not there is missed: the schema is not empty.
        assert!(!validator.is_valid(&json!({})), "{name}");
    }
}
