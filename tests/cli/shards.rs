//! `split`, `run-shard`, `merge`, `submit`: the same as one machine, and nothing else.

use crate::atlas::{map, widest};
use crate::support::Folder;
use orthocert::jobs::shard::{read_shard, sha256, Part, ShardResult, Task};
use orthocert_kernel::certificate::Node;
use std::fs;

/// A folder with shards of a map in `job`.
fn split(shards: &str) -> Folder {
    let folder = map(3);
    split_in(&folder, shards);
    folder
}

fn split_in(folder: &Folder, shards: &str) {
    let split = ["split", "map.toml", "--shards", shards, "--out", "job"];
    folder.run(&split).exits(0).says(&["SPLIT"]);
}

/// Makes the map of one machine in `one`.
fn one_machine(folder: &Folder) {
    folder.run(&["atlas", "map.toml", "-o", "one"]).exits(0);
}

fn run(folder: &Folder, shard: usize) -> crate::support::Run {
    folder.run(&["run-shard", &format!("job/shard-{shard:04}.json")])
}

fn done(shards: usize) -> Folder {
    let folder = split(&shards.to_string());
    run_all(&folder, shards);
    folder
}

fn run_all(folder: &Folder, shards: usize) {
    (1..=shards).for_each(|shard| drop(run(folder, shard).exits(0)));
}

fn is_the_same(folder: &Folder) {
    for name in ["atlas.cert.json", "best.cert.json", "map.svg", "index.html"] {
        let [one, merged] = ["one", "merged"].map(|from| folder.read(&format!("{from}/{name}")));
        assert!(one == merged, "{name}");
    }
}

/// A merge that is refused with this code and these words, and writes nothing.
fn refused(folder: &Folder, code: i32, words: &[&str]) {
    folder.run(&["merge", "job", "-o", "merged"]).exits(code).complains(words);
    assert!(!folder.path("merged").exists());
}

#[test]
fn any_number_of_shards_makes_the_map_of_one_machine() {
    let folder = map(3);
    one_machine(&folder);
    // More than there are cells: some shards have nothing to do.
    for shards in [1, 3, 12] {
        split_in(&folder, &shards.to_string());
        run_all(&folder, shards);
        folder.run(&["merge", "job", "-o", "merged"]).exits(0);
        is_the_same(&folder);
        for made in ["job", "merged"] {
            fs::remove_dir_all(folder.path(made)).unwrap();
        }
    }
}

#[test]
fn the_widest_margin_of_a_merged_map_is_that_of_one_machine() {
    let folder = widest(3);
    one_machine(&folder);
    split_in(&folder, "2");
    run_all(&folder, 2);
    folder.run(&["merge", "job", "-o", "merged", "--threads", "1"]).exits(0);
    is_the_same(&folder);
    assert!(folder.read("one/bound.cert.json") == folder.read("merged/bound.cert.json"));
}

#[test]
fn a_proof_in_shards_is_the_certificate_of_one_machine() {
    let name = "linear-delta-klipper-cylinder";
    let design = format!("{name}.toml");
    let folder = Folder::with(&[&design]);
    folder.run(&["verify", &design]).exits(0);
    folder.run(&["split", &design, "--shards", "3", "--out", "job"]).exits(0);
    run_all(&folder, 3);
    folder.run(&["merge", "job", "-o", "merged.json"]).exits(0).says(&["CERTIFIED", "520"]);
    assert!(folder.read("merged.json") == folder.read(&format!("{name}.cert.json")));
}

#[test]
fn a_design_that_is_refuted_or_undecided_is_not_merged_to_a_proof() {
    let folder = Folder::with(&["orthoglide-310.toml", "orthoglide-tolerance.toml"]);
    let refuted = ["split", "orthoglide-310.toml", "--shards", "2", "--out", "job"];
    folder.run(&refuted).exits(2).complains(&["refuted by a single point"]);
    let few =
        ["split", "orthoglide-tolerance.toml", "--shards", "1", "--max-boxes", "1", "--out", "job"];
    folder.run(&few).exits(0);
    run(&folder, 1).exits(0);
    folder.run(&["merge", "job", "-o", "merged.json"]).exits(3).says(&["UNDECIDED", "remain"]);
    assert!(!folder.path("merged.json").exists());
}

#[test]
fn a_shard_is_run_once() {
    let folder = done(2);
    let before = folder.read("job/result-0001.json");
    run(&folder, 1).exits(0).says(&["was done already"]);
    assert!(folder.read("job/result-0001.json") == before);
}

#[test]
fn a_stopped_shard_goes_on_where_it_was() {
    let folder = split("2");
    run(&folder, 1).exits(0);
    let whole = folder.read("job/result-0001.json");
    // What a run that was killed in its second cell leaves: its first one, and half a line. The
    // cell is taken over as it is: here one that says less than a new run would.
    let shard = String::from_utf8(folder.read("job/shard-0001.json")).unwrap();
    let (answers, sum) = (sha256(&shard), sha256("{\"cells\":[\"undecided\"]}"));
    let line = |sum: &str| {
        format!("{{\"answers\":\"{answers}\",\"cell\":0,\"sha256\":\"{sum}\",\"part\":{{\"cells\":[\"undecided\"]}}}}")
    };
    fs::remove_file(folder.path("job/result-0001.json")).unwrap();
    folder.write("job/result-0001.part", format!("\n{}\n\n{{\"answers\":\"", line(&sum)));
    run(&folder, 1).exits(0).says(&["1 of them by earlier runs"]);
    let resumed = String::from_utf8(folder.read("job/result-0001.json")).unwrap();
    assert!(resumed.contains("\"parts\":[{\"cells\":[\"undecided\"]},"));
    // A line that is not what was written, or of another shard, is done again.
    fs::remove_file(folder.path("job/result-0001.json")).unwrap();
    folder.write(
        "job/result-0001.part",
        format!("{}\n{}\n", line("0"), line(&sum).replace(&answers, "0")),
    );
    run(&folder, 1).exits(0);
    assert!(folder.read("job/result-0001.json") == whole);
    assert!(!folder.path("job/result-0001.part").exists());
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_exit_4_and_the_rest_is_kept() {
    let folder = split("2");
    let full = folder.run_on_a_full_disk(&["run-shard", "job/shard-0001.json"]).exits(4);
    full.complains(&["result-0001.part", "too large"]);
    assert!(!folder.path("job/result-0001.json").exists());
    run(&folder, 1).exits(0);
}

#[cfg(unix)]
#[test]
fn links_in_the_place_of_a_shards_files_are_refused() {
    let folder = split("2");
    folder.write("victim", "of somebody else");
    for name in ["result-0001.part", "result-0001.json", "result-0001.nodes"] {
        let path = folder.path(&format!("job/{name}"));
        for to in ["../victim", "../absent"] {
            std::os::unix::fs::symlink(to, &path).unwrap();
            run(&folder, 1).exits(4).complains(&[name, "a symbolic link, or no regular file"]);
            fs::remove_file(&path).unwrap();
        }
    }
    assert!(folder.read("victim") == b"of somebody else");
    assert!(!folder.path("absent").exists());
    run(&folder, 1).exits(0);
}

#[test]
fn a_missing_result_is_named() {
    let folder = done(3);
    fs::remove_file(folder.path("job/result-0002.json")).unwrap();
    refused(&folder, 4, &["shard 2 has no result"]);
}

#[test]
fn a_doubled_result_is_named() {
    let folder = done(3);
    fs::copy(folder.path("job/result-0001.json"), folder.path("job/result-0002.json")).unwrap();
    refused(
        &folder,
        2,
        &["shard 1 is there twice: result-0001.json and result-0002.json", "shard 2 has no result"],
    );
}

#[test]
fn a_result_of_another_job_is_named() {
    let (folder, other) = (done(3), map(3));
    let text = String::from_utf8(other.read("map.toml")).unwrap();
    other.write("map.toml", text.replace("max = 4", "max = 5"));
    other.run(&["split", "map.toml", "--shards", "3", "--out", "job"]).exits(0);
    run(&other, 2).exits(0);
    let alien = other.read("job/result-0002.json");
    folder.write("job/result-0002.json", &alien);
    refused(&folder, 2, &["result-0002.json is of another job"]);
    // Nor is it overwritten, or taken for done.
    run(&folder, 2).exits(2).complains(&["another job"]);
    assert!(folder.read("job/result-0002.json") == alien);
    // A shard of the other job, its result with it.
    folder.write("job/shard-0002.json", other.read("job/shard-0002.json"));
    refused(&folder, 2, &["shard-0002.json was altered, or is of another job"]);
}

#[test]
fn a_result_of_another_split_is_named() {
    let (folder, other) = (done(3), done(2));
    folder.write("job/result-0002.json", other.read("job/result-0002.json"));
    refused(&folder, 2, &["answers another split"]);
}

#[test]
fn an_edited_file_is_named() {
    let folder = done(3);
    let edited = |name: &str, from: &str, to: &str, refused: &dyn Fn()| {
        let whole = folder.read(name);
        let text = String::from_utf8(whole.clone()).unwrap();
        assert!(text.contains(from), "{name}: {from}");
        folder.write(name, text.replacen(from, to, 1));
        refused();
        folder.write(name, whole);
    };
    edited("job/result-0001.json", "\"precision\":64", "\"precision\":96", &|| {
        refused(&folder, 2, &["result-0001.json was altered"]);
    });
    edited("job/shard-0003.json", "\"boxes\":300", "\"boxes\":301", &|| {
        refused(&folder, 2, &["shard-0003.json was altered"]);
        run(&folder, 3).exits(2).complains(&["was altered"]);
    });
    edited("job/job.json", "\"resolution\":3", "\"resolution\":5", &|| {
        refused(&folder, 2, &["job.json: was altered"]);
    });
    edited("job/result-0002.json", "}", "", &|| {
        let accepted = "accepted: a result that orthocert run-shard wrote";
        refused(&folder, 2, &["result-0002.json", accepted]);
    });
    // As it was it is merged.
    folder.run(&["merge", "job", "-o", "merged"]).exits(0);
}

#[test]
fn a_forged_result_is_not_accepted() {
    // With every sum right: the checker still wants proofs.
    let folder = done(1);
    let text = String::from_utf8(folder.read("job/result-0001.json")).unwrap();
    let mut result: serde_json::Value = serde_json::from_str(&text).unwrap();
    let parts = result["parts"].as_array_mut().unwrap();
    parts.iter_mut().for_each(|part| {
        *part = serde_json::json!({"cells": [{"certified": {"precision": 64, "nodes": [{}]}}]});
    });
    let sum = sha256(&format!(
        "[{}]",
        vec![r#"{"cells":[{"certified":{"precision":64,"nodes":[{}]}}]}"#; parts.len()].join(",")
    ));
    result["sha256"] = sum.into();
    folder.write("job/result-0001.json", result.to_string());
    let run = folder.run(&["merge", "job", "-o", "merged"]).exits(5);
    run.complains(&["REJECTED", "the map was not accepted", "is not discharged"]);
    assert!(!folder.path("merged").exists());
}

#[test]
fn a_forged_proof_is_not_accepted() {
    let name = "linear-delta-klipper-cylinder.toml";
    let folder = Folder::with(&[name]);
    folder.run(&["split", name, "--shards", "2", "--out", "job"]).exits(0);
    let forge = |part: &dyn Fn() -> Part| {
        for shard in 1..=2 {
            let path = folder.path(&format!("job/shard-{shard:04}.json"));
            let (shard, answers) = read_shard(&path).unwrap();
            let parts = (0..shard.parts()).map(|_| part()).collect();
            let result = serde_json::to_string(&ShardResult::new(&shard, answers, parts)).unwrap();
            fs::write(path.with_file_name(format!("result-{:04}.json", shard.shard)), result)
                .unwrap();
        }
        folder.run(&["merge", "job", "-o", "merged.json"])
    };
    let tree =
        |nodes: usize, open, boxes| Part::Tree { nodes: vec![Node::default(); nodes], open, boxes };
    forge(&|| tree(1, 0, 1)).exits(5).complains(&["REJECTED", "the proof was not accepted"]);
    for nodes in [0, 2] {
        forge(&|| tree(nodes, 0, usize::MAX)).exits(5).complains(&["REJECTED"]);
    }
    forge(&|| Part::Cells(Vec::new())).exits(5).complains(&["do not make one tree"]);
    // Two of them would be none again.
    forge(&|| tree(1, 1 << (usize::BITS - 1), 1)).exits(3).says(&["UNDECIDED"]);
    assert!(!folder.path("merged.json").exists());
}

/// A title that would rub out a verdict and write another one.
const DISGUISE: &str = "a\u{1b}[2J\u{1b}[H\nCERTIFIED  all of it";

fn has_no_control_characters(run: &crate::support::Run) {
    for text in [&run.stdout, &run.stderr] {
        assert!(!text.chars().any(|c| c.is_control() && c != '\n'), "{text:?}");
    }
}

/// Writes a job's or shard's file with that title or label in it, and the sum that goes with it.
fn disguise(folder: &Folder, name: &str, place: &[&str]) {
    let mut file: serde_json::Value = serde_json::from_slice(&folder.read(name)).unwrap();
    let (last, above) = place.split_last().unwrap();
    let found = above.iter().fold(&mut file["task"], |value, key| &mut value[*key]);
    match last.parse::<usize>() {
        Ok(index) => found[index] = DISGUISE.into(),
        Err(_) => found[*last] = DISGUISE.into(),
    }
    let task: Task = serde_json::from_value(file["task"].clone()).unwrap();
    file["job"] = task.identity().into();
    folder.write(name, file.to_string());
}

#[test]
fn a_job_whose_texts_control_the_terminal_is_refused() {
    let found = "found a title or label with line breaks or control characters";
    let design = "orthoglide-tolerance.toml";
    let split = |place: &[&str]| {
        let folder = if place[0] == "atlas" { map(2) } else { Folder::with(&[design]) };
        folder.write("d.toml", crate::paving::DESIGN);
        let what: &[&str] = match place[0] {
            "atlas" => &["map.toml"],
            "verify" => &[design, "--max-boxes", "1"],
            _ => &["d.toml", "--pave", "--precision", "0.5"],
        };
        let rest = ["--shards", "1", "--out", "job"];
        folder.run(&[&["split"], what, &rest].concat()).exits(0);
        folder
    };
    for place in [
        &["atlas", "title"][..],
        &["atlas", "labels", "0"],
        &["pave", "title"],
        &["verify", "title"],
    ] {
        let folder = split(place);
        disguise(&folder, "job/job.json", place);
        disguise(&folder, "job/shard-0001.json", place);
        let merge = folder.run(&["merge", "job", "-o", "merged"]).exits(2);
        for run in [merge, run(&folder, 1).exits(2)] {
            has_no_control_characters(&run);
            run.complains(&[found]);
        }
    }
}

#[test]
fn a_title_that_controls_the_terminal_makes_no_job() {
    let folder = map(1);
    let text = String::from_utf8(folder.read("map.toml")).unwrap();
    let rest: Vec<_> = text.lines().filter(|line| !line.starts_with("title")).collect();
    folder.write("bad.toml", format!("title = \"a\\u001b[2J\"\n{}", rest.join("\n")));
    let bad = folder.run(&["split", "bad.toml", "--shards", "1", "--out", "job"]).exits(2);
    bad.complains(&["bad.toml: found a title or label", "texts of one line"]);
    assert!(!folder.path("job").exists());
    // A map of it is made; its report is lines.
    let run =
        folder.run(&["atlas", "bad.toml", "-o", "bad"]).exits(0).says(&["ATLAS  a\\u{1b}[2J:"]);
    has_no_control_characters(&run);
}

#[test]
fn names_in_a_jobs_files_and_folder_cannot_control_the_terminal() {
    let folder = done(1);
    let mut job: serde_json::Value = serde_json::from_slice(&folder.read("job/job.json")).unwrap();
    let whole = job.to_string();
    job[DISGUISE] = 1.into();
    folder.write("job/job.json", job.to_string());
    let run = folder.run(&["merge", "job", "-o", "merged"]).exits(2);
    has_no_control_characters(&run);
    run.complains(&["job.json: found unknown field"]);
    folder.write("job/job.json", whole);
    #[cfg(unix)]
    {
        folder.write("job/a\u{1b}[2J", "");
        let run = folder.run(&["merge", "job", "-o", "merged"]).exits(2);
        has_no_control_characters(&run);
        run.complains(&["a\\u{1b}[2J is a foreign file"]);
    }
}

#[test]
fn foreign_files_are_named() {
    let folder = done(2);
    folder.write("job/notes.txt", "");
    refused(&folder, 2, &["notes.txt is a foreign file"]);
    fs::remove_file(folder.path("job/notes.txt")).unwrap();
    folder.write("job/shard-0003.json", "{}");
    refused(&folder, 2, &["shard-0003.json is no shard of this job"]);
}

#[test]
fn bad_usage_is_refused() {
    let folder = split("2");
    folder.run(&["split", "map.toml", "--shards", "0", "--out", "x"]).exits(2);
    folder.run(&["split", "map.toml", "--shards", "10001", "--out", "x"]).exits(2);
    let again = ["split", "map.toml", "--shards", "2", "--out", "job"];
    folder.run(&again).exits(2).complains(&["job has files in it", "a new folder"]);
    folder
        .run(&["run-shard", "map.toml"])
        .exits(2)
        .complains(&["a shard that orthocert split wrote"]);
    folder.run(&["run-shard", "job/job.json"]).exits(2).complains(&["accepted: a shard"]);
    folder.run(&["run-shard", "absent.json"]).exits(2).complains(&["cannot be read"]);
    fs::create_dir(folder.path("empty")).unwrap();
    folder.run(&["merge", "empty", "-o", "merged"]).exits(2).complains(&["job.json"]);
}

#[test]
fn scripts_are_written_and_missing_engines_named() {
    let folder = done(2);
    let submit = |engine: &str, more: &[&str]| {
        let mut arguments = vec!["submit", "job", "--engine", engine, "-o", "merged"];
        arguments.extend(more);
        let mut command = folder.command(&arguments);
        // No engine is on an empty path.
        crate::support::Run::from(command.env("PATH", folder.path("empty")).output().unwrap())
    };
    submit("slurm", &["--scripts-only"]).exits(0).says(&["SCRIPTS", "2 shards"]);
    let script = String::from_utf8(folder.read("job/engine/array.sbatch")).unwrap();
    for part in ["#SBATCH --array=1-2\n", "#SBATCH --requeue\n", "scontrol requeue"] {
        assert!(script.contains(part), "{script}");
    }
    submit("slurm", &[]).exits(4).complains(&["sbatch is not installed here"]);
    submit("hyperqueue", &[]).exits(4).complains(&["python3 is not installed here"]);
    submit("hyperqueue", &["--", "--partition=x"]).exits(2).complains(&["for sbatch"]);
    submit("pbs", &[]).exits(2);
    // The folder with scripts in it is still the job's.
    folder.run(&["merge", "job", "-o", "merged"]).exits(0);
    one_machine(&folder);
    is_the_same(&folder);
}
