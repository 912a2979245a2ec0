//! `split --pave`, and what becomes of its shards: the paving of one machine, and nothing else.

use crate::paving::DESIGN;
use crate::support::{Folder, Run};
use orthocert::files::digest;
use orthocert_kernel::paving::{Item, Kind};
use serde_json::{json, Value};
use std::fs;
use std::process::Stdio;

const PRECISION: &str = "0.05";

/// A folder with shards of a paving in `job`.
fn split_of(design: &str, precision: &str, shards: &str) -> Folder {
    let folder = Folder::new();
    folder.write("d.toml", design);
    let pave = ["--pave", "--precision", precision, "--shards", shards, "--out", "job"];
    folder.run(&[&["split", "d.toml"][..], &pave].concat()).exits(0).says(&["SPLIT"]);
    folder
}

fn split(shards: &str) -> Folder {
    split_of(DESIGN, PRECISION, shards)
}

/// Makes the paving of one machine in `one`.
fn one_machine(folder: &Folder, precision: &str) {
    folder.run(&["pave", "d.toml", "--precision", precision, "-o", "one"]).exits(0);
}

fn run(folder: &Folder, shard: usize) -> Run {
    folder.run(&["run-shard", &format!("job/shard-{shard:04}.json")])
}

fn done(shards: usize) -> Folder {
    let folder = split(&shards.to_string());
    (1..=shards).for_each(|shard| drop(run(&folder, shard).exits(0)));
    folder
}

fn merge(folder: &Folder) -> Run {
    folder.run(&["merge", "job", "-o", "merged"])
}

/// A merge that is refused with this code and these words, and leaves what was there.
fn refused(folder: &Folder, code: i32, words: &[&str]) {
    folder.write("merged", "earlier");
    folder.write("merged.part", "of a run that was interrupted");
    let before = folder.names();
    merge(folder).exits(code).complains(words);
    assert!(folder.read("merged") == b"earlier");
    assert_eq!(folder.names(), before);
}

fn result(folder: &Folder, shard: usize) -> Value {
    serde_json::from_slice(&folder.read(&format!("job/result-{shard:04}.json"))).unwrap()
}

#[test]
fn any_number_of_shards_makes_the_paving_of_one_machine() {
    // Not symmetric, with bounds of several kinds; and with cells left out by symmetry.
    let other = DESIGN.replace("min = [-0.7, -0.7, -0.7]", "min = [-0.6, -0.7, -0.7]");
    let other = other.replace("max = 2 }", "max = 2 }\n    conditioning = { max = 3 }");
    for (design, precision, shards) in [
        (DESIGN, PRECISION, 1),
        (DESIGN, PRECISION, 3),
        (&other, "0.1", 7),
        (DESIGN, PRECISION, 60),
    ] {
        let folder = split_of(design, precision, &shards.to_string());
        one_machine(&folder, precision);
        for shard in (1..=shards).rev() {
            run(&folder, shard).exits(0);
        }
        let says = ["volume: between", "every box confirmed by the exact checker"];
        merge(&folder).exits(0).says(&says);
        assert!(folder.read("merged") == folder.read("one"), "{shards}");
        folder.run(&["check", "merged", "--design", "d.toml"]).exits(0).says(&["ACCEPTED"]);
    }
}

#[test]
fn the_answer_of_a_merge_has_the_facts_of_the_paving() {
    let folder = done(2);
    let answer = |arguments: &[&str]| -> Value {
        let run = folder.run(&[arguments, &["--format", "json"]].concat()).exits(0);
        serde_json::from_str(&run.stdout).unwrap()
    };
    let one = answer(&["pave", "d.toml", "--precision", PRECISION]);
    let merged = answer(&["merge", "job", "-o", "merged"]);
    for fact in ["gap", "inner", "outer", "boundary", "components", "depth", "boxes", "reached"] {
        assert_eq!(one[fact], merged[fact], "{fact}");
    }
}

#[test]
fn merges_at_the_same_time_do_not_disturb_each_other() {
    let folder = done(2);
    one_machine(&folder, PRECISION);
    // What an earlier merge may have left, or somebody put there.
    folder.write("merged.merging", "of somebody else");
    let merge = || folder.command(&["merge", "job", "-o", "merged", "--threads", "1"]);
    let started: Vec<_> = (0..4)
        .map(|_| merge().stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap())
        .collect();
    for child in started {
        Run::from(child.wait_with_output().unwrap()).exits(0).says(&["volume: between"]);
    }
    assert!(folder.read("merged") == folder.read("one"));
    assert!(folder.read("merged.merging") == b"of somebody else");
    assert_eq!(folder.names(), ["d.toml", "job", "merged", "merged.merging", "one"]);
}

#[test]
fn a_shard_is_run_once_unless_its_nodes_were_altered() {
    let folder = done(2);
    run(&folder, 1).exits(0).says(&["was done already"]);
    let whole = folder.read("job/result-0001.nodes");
    let mut longer = whole.clone();
    longer.push(0);
    for altered in [&whole[1..], &longer, &[]] {
        folder.write("job/result-0001.nodes", altered);
        run(&folder, 1).exits(0).says(&["done, "]);
        assert!(folder.read("job/result-0001.nodes") == whole);
    }
    fs::remove_file(folder.path("job/result-0001.nodes")).unwrap();
    run(&folder, 1).exits(0);
    assert!(folder.read("job/result-0001.nodes") == whole);
}

#[test]
fn a_stopped_shard_goes_on_where_it_was() {
    let folder = done(2);
    let (whole, nodes) =
        (folder.read("job/result-0001.json"), folder.read("job/result-0001.nodes"));
    let found = result(&folder, 1);
    let line = |cell: usize| {
        let part = &found["parts"][cell];
        let (bytes, sum) = (&part["nodes"]["bytes"], &part["nodes"]["sha256"]);
        let part = format!(r#"{{"nodes":{{"bytes":{bytes},"sha256":{sum}}}}}"#);
        let (answers, sum) = (&found["answers"], digest::sha256(part.as_bytes()));
        format!(
            "\n{{\"answers\":{answers},\"cell\":{cell},\"sha256\":\"{sum}\",\"part\":{part}}}\n"
        )
    };
    let end = |cells: usize| -> usize {
        let bytes = |cell: usize| found["parts"][cell]["nodes"]["bytes"].as_u64().unwrap();
        usize::try_from((0..cells).map(bytes).sum::<u64>()).unwrap()
    };
    // What a run that was killed in its fourth cell leaves; the same with a byte of the second
    // altered; with lines of which the file has not all; with nodes of a cell but no line of it.
    let three: String = (0..3).map(line).collect();
    let mut altered = nodes[..end(3) + 2].to_vec();
    altered[end(1)] ^= 1;
    let cases = [
        (format!("{three}\n{{\"answers\":"), nodes[..end(3) + 2].to_vec(), "3 of them"),
        (three.clone(), altered, "1 of them"),
        (three.clone(), nodes[..end(2)].to_vec(), "2 of them"),
        (line(0) + &line(2), nodes.clone(), "1 of them"),
    ];
    for (progress, written, says) in cases {
        fs::remove_file(folder.path("job/result-0001.json")).unwrap();
        folder.write("job/result-0001.part", progress);
        folder.write("job/result-0001.nodes", written);
        run(&folder, 1).exits(0).says(&[says]);
        assert!(folder.read("job/result-0001.json") == whole, "{says}");
        assert!(folder.read("job/result-0001.nodes") == nodes, "{says}");
        assert!(!folder.path("job/result-0001.part").exists());
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_exit_4_and_the_rest_is_kept() {
    let folder = split("2");
    let full = folder.run_on_a_full_disk(&["run-shard", "job/shard-0001.json"]).exits(4);
    full.complains(&["result-0001.nodes", "too large"]);
    assert!(!folder.path("job/result-0001.json").exists());
    run(&folder, 1).exits(0);
}

#[test]
fn what_is_missing_doubled_altered_or_foreign_is_named() {
    let folder = done(3);
    one_machine(&folder, PRECISION);
    let nodes = |shard: usize| folder.path(&format!("job/result-{shard:04}.nodes"));
    let kept = fs::read(nodes(2)).unwrap();
    // Missing.
    fs::remove_file(nodes(2)).unwrap();
    refused(&folder, 2, &["result-0002.nodes cannot be read"]);
    // Doubled.
    fs::copy(nodes(1), nodes(2)).unwrap();
    refused(&folder, 2, &["result-0002.nodes was altered"]);
    // Altered: a byte, the last one, one too many.
    for altered in [
        [&kept[..40], &[kept[40] ^ 4], &kept[41..]].concat(),
        kept[..kept.len() - 1].to_vec(),
        [&kept[..], &[0]].concat(),
    ] {
        fs::write(nodes(2), altered).unwrap();
        refused(&folder, 2, &["result-0002.nodes was altered"]);
    }
    fs::write(nodes(2), &kept).unwrap();
    // Foreign.
    fs::write(nodes(4), &kept).unwrap();
    refused(&folder, 2, &["result-0004.nodes is a foreign file"]);
    fs::remove_file(nodes(4)).unwrap();
    // The whole result missing, doubled, edited.
    let path = folder.path("job/result-0002.json");
    let text = fs::read_to_string(&path).unwrap();
    fs::remove_file(&path).unwrap();
    refused(&folder, 4, &["shard 2 has no result"]);
    fs::copy(folder.path("job/result-0003.json"), &path).unwrap();
    refused(&folder, 2, &["shard 3 is there twice", "shard 2 has no result"]);
    fs::write(&path, text.replacen("\"bytes\":", "\"bytes\":1", 1)).unwrap();
    refused(&folder, 2, &["result-0002.json was altered"]);
    fs::write(&path, text).unwrap();
    merge(&folder).exits(0);
    assert!(folder.read("merged") == folder.read("one"));
}

#[test]
fn results_of_another_precision_are_of_another_job() {
    let (folder, other) = (done(2), split_of(DESIGN, "0.1", "2"));
    run(&other, 2).exits(0);
    for name in ["job/result-0002.json", "job/result-0002.nodes"] {
        folder.write(name, other.read(name));
    }
    refused(&folder, 2, &["result-0002.json is of another job"]);
}

/// Gives a result these nodes for each of its cells, with every sum right.
fn forge(folder: &Folder, shard: usize, item: &[u8]) {
    let mut found = result(folder, shard);
    let cells = found["parts"].as_array().unwrap().len();
    let part = json!({"nodes": {"bytes": item.len(), "sha256": digest::sha256(item)}});
    found["parts"] = vec![part; cells].into();
    found["sha256"] = digest::sha256(found["parts"].to_string().as_bytes()).into();
    folder.write(&format!("job/result-{shard:04}.json"), found.to_string());
    folder.write(&format!("job/result-{shard:04}.nodes"), item.repeat(cells));
}

#[test]
fn a_forged_result_is_not_accepted() {
    let node = |kind: Kind| {
        let mut bytes = Vec::new();
        Item { steps: Vec::new(), kind }.write(&mut bytes).unwrap();
        bytes
    };
    let boundary = node(Kind::Boundary);
    for (forged, words) in [
        (node(Kind::Inner), "is not certainly met"),
        (node(Kind::Mirrored), "is left out by symmetry, but"),
        // More nodes, or fewer, than a tree has.
        ([boundary.clone(), boundary.clone()].concat(), "a box is left undecided after"),
        (Vec::new(), "does not accept the paving"),
        // True, but not what was asked for.
        (boundary, "a box is left undecided after"),
    ] {
        let folder = done(1);
        forge(&folder, 1, &forged);
        refused(&folder, 5, &["REJECTED: nothing was merged", words]);
        let json = folder.run(&["merge", "job", "-o", "merged", "--format", "json"]).exits(5);
        let answer: Value = serde_json::from_str(&json.stdout).unwrap();
        assert_eq!(answer["accepted"], false);
        assert!(answer["reason"].as_str().unwrap().contains(words), "{answer}");
    }
}

#[test]
fn a_merge_leaves_the_folder_of_the_shards_alone() {
    let folder = done(1);
    let before = fs::read(folder.path("job/shard-0001.json")).unwrap();
    for output in ["job/shard-0001.json", "job/job.json", "./job/new", "job"] {
        let run = folder.run(&["merge", "job", "-o", output]).exits(2);
        run.complains(&["--output", "in the folder of the shards"]);
        let submit = ["submit", "job", "--engine", "slurm", "--scripts-only", "-o", output];
        folder.run(&submit).exits(2).complains(&["in the folder of the shards"]);
    }
    assert!(fs::read(folder.path("job/shard-0001.json")).unwrap() == before);
    merge(&folder).exits(0);
}

#[test]
fn a_shard_in_the_place_of_its_own_files_is_refused() {
    let folder = split("1");
    let shard = folder.read("job/shard-0001.json");
    for name in ["result-0001.json", "result-0001.part", "result-0001.nodes"] {
        folder.write(name, &shard);
        folder.run(&["run-shard", name]).exits(2).complains(&[name, "accepted: the name"]);
        assert!(folder.read(name) == shard);
        fs::remove_file(folder.path(name)).unwrap();
    }
}

#[test]
fn cells_that_the_paving_does_not_have_are_refused() {
    let folder = split("2");
    let text = folder.read("job/shard-0001.json");
    let mut shard: Value = serde_json::from_slice(&text).unwrap();
    let malformed = "a cell that is not within the box";
    for edges in [json!([[0, 20], [0, 0], [0, 0]]), json!([[9, 3], [0, 0], [0, 0]])] {
        shard["cells"][0]["edges"] = edges;
        folder.write("job/shard-0001.json", shard.to_string());
        run(&folder, 1).exits(2).complains(&[malformed]);
    }
}

#[test]
fn bad_usage_is_refused() {
    let folder = Folder::with(&["orthoglide-prototype.toml"]);
    folder.write("d.toml", DESIGN);
    folder.write("map.toml", "[parameters]\n[atlas]\n");
    let flags = |job: &'static str, rest: &[&'static str]| {
        [&["split", job, "--shards", "2", "--out", "job"][..], rest].concat()
    };
    for (arguments, complaint) in [
        (flags("d.toml", &["--pave"]), "--precision"),
        (flags("d.toml", &["--precision", "0.1"]), "--pave"),
        (flags("d.toml", &["--pave", "--precision", "0"]), "accepted: a positive number"),
        (flags("d.toml", &["--pave", "--precision", "1e-20"]), "at most 90 splits"),
        (
            flags("d.toml", &["--pave", "--precision", "0.1", "--max-boxes", "9"]),
            "cannot be used with",
        ),
        (flags("map.toml", &["--pave", "--precision", "0.1"]), "--pave: found an atlas"),
        (
            flags("orthoglide-prototype.toml", &["--pave", "--precision", "1"]),
            "workspace.cube: found a cube",
        ),
    ] {
        folder.run(&arguments).exits(2).complains(&[complaint]);
        assert!(!folder.path("job").exists());
    }
    let folder = split("1");
    run(&folder, 1).exits(0);
    let device = folder.run(&["merge", "job", "-o", "/dev/null"]).exits(2);
    device.complains(&["not a regular file"]);
}

#[test]
fn another_box_is_paved_in_shards_as_by_one_machine() {
    let folder = Folder::with(&["linear-delta-klipper-cylinder.toml"]);
    let design = "linear-delta-klipper-cylinder.toml";
    let range = ["--box", "-60,60,-60,60,0,50", "--precision", "15"];
    folder.run(&[&["pave", design, "-o", "one"][..], &range].concat()).exits(0);
    let split = ["split", design, "--pave", "--shards", "2", "--out", "job"];
    folder.run(&[&split[..], &range].concat()).exits(0);
    (1..=2).for_each(|shard| drop(run(&folder, shard).exits(0)));
    merge(&folder).exits(0);
    assert!(folder.read("merged") == folder.read("one"));
    let split = ["split", design, "--shards", "2", "--out", "other", "--box", "0,1,0,1,0,1"];
    folder.run(&split).exits(2).complains(&["--pave"]);
}
