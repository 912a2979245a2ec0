//! `pave`, and `check` of pavings.

use crate::support::{Folder, Run};
use orthocert::exact::Exact;
use orthocert_kernel::certificate::Failure;
use orthocert_kernel::paving::{Cut, Item, Judge, Kind, Outer, Reader, Step, Subject};
use serde_json::Value;
use std::cmp::Ordering;
use std::io::Write;
use std::process::Stdio;

/// The Orthoglide with legs of length one, over a box that reaches beyond its region.
pub const DESIGN: &str = r#"
    [mechanism]
    kind = "orthoglide"
    leg_length = 1
    [workspace]
    min = [-0.7, -0.7, -0.7]
    max = [0.7, 0.7, 0.7]
    [requirements]
    transmission = { min = "1/2", max = 2 }
"#;

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("d.toml", DESIGN);
    folder
}

#[test]
fn a_box_is_paved_and_the_paving_is_accepted() {
    let folder = folder();
    let run = folder.run(&["pave", "d.toml", "--volume-gap", "0.1"]).exits(0);
    run.says(&["volume: between 1.5", "and 1.6", "inner", "outer", "boundary", "d.paving"]);
    folder.run(&["check", "d.paving"]).exits(0).says(&[
        "ACCEPTED: paving",
        "It is proved: the volume of R is at least the share",
        "psi_i >= 0.5",
        "psi_i <= 2",
    ]);
    folder.run(&["check", "d.paving", "--design", "d.toml"]).exits(0);
    let sampled = folder.run(&["check", "d.paving", "--sample", "50", "--seed", "7"]).exits(0);
    sampled.says(&["The evidence of 50 of the", "If that of the others holds"]);
    let quiet = |more: &[&str]| folder.run(&[&["check", "-q", "d.paving"], more].concat()).exits(0);
    assert_eq!(quiet(&[]).stdout, "ACCEPTED: paving\n");
    let sampled = quiet(&["--sample", "50", "--seed", "7"]).stdout;
    assert_eq!(sampled, "ACCEPTED: paving, by 50 boxes of --seed 7\n");
    assert_eq!(folder.names(), ["d.paving", "d.toml"]);
}

/// The number before ` %` that follows a word, in hundredths.
fn percent_after(text: &str, word: &str) -> Exact {
    let (_, rest) = text.split_once(word).unwrap();
    let (number, _) = rest.split_once(" %").unwrap();
    let number = number.rsplit([' ', '>']).next().unwrap();
    let hundredth = Exact::parse("1/100", 1000).unwrap();
    Exact::parse(number, 1000).unwrap().times(hundredth).unwrap()
}

#[test]
fn no_share_is_shown_that_is_more_than_certified() {
    let folder = folder();
    let mut rounded = 0;
    for edge in ["0.1", "0.05", "0.03"] {
        let arguments = ["pave", "d.toml", "--precision", edge];
        let text = folder.run(&arguments).exits(0).stdout;
        let json = folder.run(&[&arguments[..], &["--format", "json"]].concat()).exits(0);
        folder.run(&["report", "d.paving"]).exits(0);
        let page = String::from_utf8(folder.read("d.paving.report.html")).unwrap();
        let overview = &page[page.find("what is proved of them").unwrap()..];
        let components = &page[page.find("Connected components</h2>").unwrap()..];
        let answer: Value = serde_json::from_str(&json.stdout).unwrap();
        for (part, row, name, order) in [
            ("inner", "\n  inner ", "<td>inner</td>", Ordering::Less),
            ("outer", "\n  outer ", "<td>outer</td>", Ordering::Less),
            ("boundary", "\n  boundary ", "<td>undecided</td>", Ordering::Greater),
            ("inner", "shared faces; ", "images, itself included", Ordering::Less),
        ] {
            let share = Exact::parse(answer[part]["share"].as_str().unwrap(), 1000).unwrap();
            let page = if name.starts_with('<') { overview } else { components };
            for shown in [percent_after(&text, row), percent_after(page, name)] {
                let found = shown.compare(&share).unwrap();
                assert!(found == order || found == Ordering::Equal, "{part} {shown} {share}");
                rounded += usize::from(found == order);
            }
        }
    }
    assert!(rounded > 12, "{rounded} of 24 are rounded");
}

#[test]
fn the_bytes_do_not_depend_on_threads_and_the_json_has_the_same_facts() {
    let folder = folder();
    let mut first = Vec::new();
    for threads in ["1", "2", "5"] {
        let run = folder.run(&[
            "pave",
            "d.toml",
            "--precision",
            "0.02",
            "--threads",
            threads,
            "--format",
            "json",
        ]);
        let run = run.exits(0);
        let answer: Value = serde_json::from_str(&run.stdout).unwrap();
        // V = 1.4^3 = 2.744 <= 2^19 0.02^3 = 4.19.
        assert_eq!(answer["depth"], 19);
        let (inner, open) = (&answer["inner"]["share"], &answer["boundary"]["share"]);
        assert!(inner.is_string() && open.is_string());
        let gap = answer["gap"].as_f64().unwrap();
        assert!((0.05..0.5).contains(&gap), "{gap}");
        let bytes = folder.read("d.paving");
        assert_eq!(answer["bytes"], bytes.len());
        if first.is_empty() {
            first = bytes;
        } else {
            assert!(first == bytes, "{threads} threads");
        }
    }
}

#[test]
fn a_paving_is_taken_up_from_wherever_it_ends() {
    let folder = folder();
    let pave = ["pave", "d.toml", "--precision", "0.015"];
    folder.run(&pave).exits(0);
    let whole = folder.read("d.paving");
    let start = whole.iter().position(|byte| *byte == b'\n').unwrap() + 1;
    for length in [start, start + 1, whole.len() / 3, whole.len() - 1] {
        folder.write("d.paving.part", &whole[..length]);
        folder.write("d.paving", "earlier");
        folder.run(&[&pave[..], &["--resume"]].concat()).exits(0);
        assert!(folder.read("d.paving") == whole, "{length} bytes");
        assert_eq!(folder.names(), ["d.paving", "d.toml"]);
    }
    // What does not prove what it says is not taken up, but made again.
    let mut spoiled = whole.clone();
    let middle = whole.len() / 2;
    spoiled[middle..middle + 50].fill(3);
    folder.write("d.paving.part", &spoiled);
    folder.run(&[&pave[..], &["--resume"]].concat()).exits(0);
    assert!(folder.read("d.paving") == whole, "spoiled");
}

/// A paving's first line, and its nodes, each with its depth.
fn nodes(bytes: &[u8]) -> (Vec<u8>, Vec<(u32, Item)>) {
    let mut reader = Reader::new(bytes).unwrap();
    let mut nodes = Vec::new();
    while let Some(visited) = reader.next().unwrap() {
        nodes.push((visited.depth, visited.item));
    }
    let end = bytes.iter().position(|byte| *byte == b'\n').unwrap() + 1;
    (bytes[..end].to_vec(), nodes)
}

/// The file with these nodes, and the summary that they have.
fn written(first: &[u8], nodes: &[Item]) -> Vec<u8> {
    let mut bytes = first.to_vec();
    nodes.iter().for_each(|item| item.write(&mut bytes).unwrap());
    let mut reader = Reader::new(bytes.as_slice()).unwrap();
    while reader.next().unwrap().is_some() {}
    let summary = serde_json::to_vec(&reader.summary).unwrap();
    [&bytes[..], &summary, b"\n"].concat()
}

#[test]
fn what_is_taken_up_is_as_fine_as_what_is_grown() {
    let folder = folder();
    let pave = ["pave", "d.toml", "--precision", "0.015"];
    folder.run(&pave).exits(0);
    let whole = folder.read("d.paving");
    let (mut cut, nodes) = nodes(&whole);
    // The subtrees that are taken up begin after 18 splits: none is there, all is undecided.
    for (depth, item) in nodes.iter().filter(|(depth, _)| *depth <= 18) {
        match item.kind {
            Kind::Split(_) if *depth == 18 => cut.push(4),
            _ => item.write(&mut cut).unwrap(),
        }
    }
    folder.write("d.paving.part", &cut);
    folder.run(&[&pave[..], &["--resume"]].concat()).exits(0);
    assert!(folder.read("d.paving") == whole);
}

#[test]
fn a_design_or_a_strangers_file_is_no_unfinished_paving() {
    let folder = Folder::new();
    folder.write("q.part", DESIGN);
    folder
        .run(&["pave", "q.part", "-o", "q"])
        .exits(2)
        .complains(&["--output", "is a file that is read"]);
    folder.run(&["pave", "q.part", "-o", "./q"]).exits(2);
    folder.write("d.toml", DESIGN);
    folder.write("d.paving.part", "a letter");
    let run = folder.run(&["pave", "d.toml"]).exits(2);
    run.complains(&["d.paving.part", "no unfinished paving", "another path"]);
    assert_eq!(folder.read("q.part"), DESIGN.as_bytes());
    assert_eq!(folder.read("d.paving.part"), b"a letter");
    assert_eq!(folder.names(), ["d.paving.part", "d.toml", "q.part"]);
}

#[test]
fn a_sample_is_drawn_by_a_seed_that_nobody_knew() {
    let folder = folder();
    folder.run(&["pave", "d.toml", "--volume-gap", "0.3"]).exits(0);
    let answer = |more: &[&str]| -> Value {
        let check = [&["check", "d.paving", "--format", "json", "--sample", "5"][..], more];
        serde_json::from_str(&folder.run(&check.concat()).exits(0).stdout).unwrap()
    };
    let seeds = [answer(&[]), answer(&[])].map(|answer| answer["seed"].clone());
    assert_ne!(seeds[0], seeds[1]);
    let again = answer(&["--seed", seeds[0].as_str().unwrap()]);
    assert_eq!(again["seed"], seeds[0]);
    folder.run(&["check", "d.paving", "--sample", "5"]).exits(0).says(&["Drawn with --seed "]);
    let whole: Value =
        serde_json::from_str(&folder.run(&["check", "d.paving", "--format", "json"]).stdout)
            .unwrap();
    assert!(whole.get("seed").is_none());
    assert_eq!(whole["sha256"], orthocert::files::digest::sha256(&folder.read("d.paving")));
    // Where something is false, which draw found it is said.
    let (first, nodes) = nodes(&folder.read("d.paving"));
    let forged: Vec<Item> = nodes
        .into_iter()
        .map(|(_, item)| match item.kind {
            Kind::Outer(_) => {
                let reach = Outer::Given(Failure::Reach.into());
                Item { steps: Vec::new(), kind: Kind::Outer(reach) }
            }
            _ => item,
        })
        .collect();
    folder.write("forged", written(&first, &forged));
    let run = folder.run(&["check", "forged", "--sample", "50"]).exits(5);
    run.complains(&["is not outer", "drawn with --seed "]);
    folder.run(&["check", "d.paving", "--sample", "1000001"]).exits(2).complains(&["--sample"]);
}

#[test]
fn boxes_that_are_not_drawn_have_evidence_all_the_same() {
    let folder = folder();
    folder.run(&["pave", "d.toml", "--volume-gap", "0.3"]).exits(0);
    let (first, nodes) = nodes(&folder.read("d.paving"));
    let bare = |kind| Item { steps: Vec::new(), kind };
    let forged = |forge: &dyn Fn(&Item) -> Item| {
        let items: Vec<Item> = nodes.iter().map(|(_, item)| forge(item)).collect();
        folder.write("forged", written(&first, &items));
    };
    forged(&|item| match item.kind {
        Kind::Inner => Item { steps: vec![Step(2, None)], kind: Kind::Inner },
        _ => item.clone(),
    });
    for seed in ["0", "1", "2"] {
        let run = folder.run(&["check", "forged", "--sample", "1", "--seed", seed]).exits(5);
        run.complains(&["obligation 2", "is not certainly met"]);
    }
    forged(&|item| match item.kind {
        Kind::Outer(_) => bare(Kind::Outer(Outer::Own(2))),
        _ => item.clone(),
    });
    folder.run(&["check", "forged", "--sample", "1"]).exits(5).complains(&["is not outer"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_paving_through_a_pipe_is_read_once() {
    let folder = folder();
    folder.run(&["pave", "d.toml", "--precision", "0.008"]).exits(0);
    let bytes = folder.read("d.paving");
    // More than a pipe holds.
    assert!(bytes.len() > 1 << 16);
    let piped = |arguments: &[&str], bytes: &[u8]| {
        let (reader, mut writer) = std::io::pipe().unwrap();
        let mut command = folder.command(arguments);
        command.stdin(reader).stdout(Stdio::piped()).stderr(Stdio::piped());
        let child = command.spawn().unwrap();
        drop(command);
        // A reader that has had enough is no matter.
        let _ = writer.write_all(bytes);
        drop(writer);
        Run::from(child.wait_with_output().unwrap())
    };
    let sum = orthocert::files::digest::sha256(&bytes);
    piped(&["check", "/dev/stdin"], &bytes).exits(0).says(&["ACCEPTED: paving", &sum]);
    let sampled = ["check", "/dev/stdin", "--sample", "9"];
    piped(&sampled, &bytes).exits(0).says(&["The evidence of 9 of the"]);
    let report = ["report", "/dev/stdin", "-o", "r.html", "--format", "json"];
    piped(&report, &bytes).exits(0).says(&[&sum]);
    piped(&["export", "stl", "/dev/stdin", "-o", "r.stl"], &bytes).exits(0).says(&[&sum]);
    for cut in [bytes.len() / 2, bytes.len() - 1] {
        piped(&["check", "/dev/stdin"], &bytes[..cut]).exits(5).complains(&["REJECTED"]);
    }
}

#[cfg(unix)]
#[test]
fn a_link_in_the_place_of_the_unfinished_paving_is_refused() {
    let folder = folder();
    let pave = ["pave", "d.toml", "--volume-gap", "0.3"];
    folder.run(&pave).exits(0);
    let whole = folder.read("d.paving");
    folder.write("victim", &whole[..whole.len() / 2]);
    let part = folder.path("d.paving.part");
    let refused = |more: &[&str]| {
        let run = folder.run(&[&pave[..], more].concat()).exits(4);
        run.complains(&["d.paving.part", "a symbolic link, or no regular file"]);
    };
    std::os::unix::fs::symlink("victim", &part).unwrap();
    refused(&[]);
    refused(&["--resume"]);
    assert!(folder.read("victim") == whole[..whole.len() / 2]);
    std::fs::remove_file(&part).unwrap();
    // Nor is a pipe waited for.
    assert!(std::process::Command::new("mkfifo").arg(&part).status().unwrap().success());
    refused(&[]);
    refused(&["--resume"]);
    assert!(folder.read("d.paving") == whole);
}

#[test]
fn there_has_to_be_something_to_take_up() {
    let folder = folder();
    let resume = ["pave", "d.toml", "--resume"];
    folder.run(&resume).exits(2).complains(&["d.paving.part", "cannot be taken up again"]);
    folder.run(&["pave", "d.toml", "--volume-gap", "0.3"]).exits(0);
    folder.write("d.paving.part", folder.read("d.paving"));
    folder.write("d.toml", DESIGN.replace("max = 2 }", "max = 3 }"));
    folder.run(&resume).exits(2).complains(&["another design's paving"]);
    folder.write("d.toml", DESIGN);
    let coarser = [&resume[..], &["--precision", "0.5"]].concat();
    folder.run(&coarser).exits(2).complains(&["smaller --precision"]);
    folder.run(&resume).exits(0);
}

#[test]
fn files_that_prove_nothing_are_rejected() {
    let folder = folder();
    folder.run(&["pave", "d.toml", "--volume-gap", "0.3"]).exits(0);
    let bytes = folder.read("d.paving");
    folder.write("cut.paving", &bytes[..bytes.len() - 1]);
    folder.run(&["check", "cut.paving"]).exits(5).complains(&["REJECTED", "last line"]);
    folder.write("half.paving", &bytes[..bytes.len() / 2]);
    folder.run(&["check", "half.paving"]).exits(5).complains(&["REJECTED", "end within node"]);
    folder.write("other.toml", DESIGN.replace("max = 2 }", "max = 3 }"));
    let other = folder.run(&["check", "d.paving", "--design", "other.toml"]).exits(5);
    other.complains(&["another claim than the design's"]);
    let json = folder.run(&["check", "half.paving", "--format", "json"]).exits(5);
    let answer: Value = serde_json::from_str(&json.stdout).unwrap();
    assert_eq!(answer["accepted"], false);
}

#[test]
fn too_few_boxes_leave_the_gap_open() {
    let folder = folder();
    let few = ["pave", "d.toml", "--volume-gap", "0.001", "--max-boxes", "30000"];
    folder.run(&few).exits(3).says(&["What was asked for is not reached"]);
    folder.run(&["check", "d.paving"]).exits(0);
}

/// Cells that are their own images are not cut, and are split along the planes' normals too: with joint coordinates that grow
/// by as much as x does, x was never halved there, and a gap of 0.07 was out of reach.
#[test]
fn cells_on_planes_of_symmetry_are_split_along_all_axes() {
    let folder = folder();
    let design = "[mechanism]\nkind = \"orthoglide\"\nleg_length = 410\nbase = -540\noffset = 30\n[workspace]\n\
                  min = [-200, -200, -200]\nmax = [200, 200, 200]\n[requirements]\njoint_range = { min = 0, max = 320 }\n";
    folder.write("d.toml", design);
    let gap =
        ["pave", "d.toml", "--volume-gap", "0.05", "--max-boxes", "20000", "--format", "json"];
    let answer: Value = serde_json::from_str(&folder.run(&gap).exits(0).stdout).unwrap();
    assert!(answer["gap"].as_f64().unwrap() < 0.05, "{answer}");
}

#[test]
fn components_are_of_whole_boxes() {
    let folder = folder();
    let run = folder.run(&["pave", "d.toml", "--volume-gap", "0.2", "-o", "cut.paving"]).exits(0);
    run.says(&["of whole inner boxes: the parts of boxes that planes cut"]);
    folder.write("d.toml", format!("unit = \"mm\"\n{DESIGN}"));
    let run = folder.run(&["pave", "d.toml", "--precision", "0.2", "-o", "whole.paving"]);
    assert!(run.stdout.lines().next().unwrap().contains(" mm^3, gap"), "{}", run.stdout);
    assert!(run.stdout.contains("components") && !run.stdout.contains("that planes cut, which"));
}

#[test]
fn bad_usage_is_refused() {
    let folder = folder();
    folder.write("cube.toml", "[mechanism]\nkind = \"orthoglide\"\n[workspace]\ncube = 200\n[requirements]\ntransmission = { max = 2 }\n");
    folder
        .write("flat.toml", DESIGN.replace("min = [-0.7, -0.7, -0.7]", "min = [-0.7, -0.7, 0.7]"));
    for (arguments, complaint) in [
        (&["pave", "d.toml", "--precision", "0"][..], "--precision: found 0"),
        (&["pave", "d.toml", "--precision", "1e-20"], "at most 90 splits"),
        (&["pave", "d.toml", "--volume-gap", "-1"], "accepted: a positive number"),
        (&["pave", "d.toml", "--volume-gap", "x"], "not a number"),
        (&["pave", "d.toml", "--precision", "1", "--volume-gap", "1"], "cannot be used with"),
        (&["pave", "d.toml", "--max-boxes", "0"], "--max-boxes"),
        (&["pave", "cube.toml"], "cube.toml:4:1: workspace.cube: found a cube"),
        (&["pave", "flat.toml"], "a box of positive volume"),
        (&["pave", "missing.toml"], "missing.toml"),
    ] {
        folder.run(arguments).exits(2).complains(&[complaint]);
    }
    for (output, complaint) in
        [("/dev/null", "not a regular file"), ("d.toml", "is a file that is read")]
    {
        folder.run(&["pave", "d.toml", "-o", output]).exits(2).complains(&[complaint]);
    }
    assert_eq!(folder.names(), ["cube.toml", "d.toml", "flat.toml"]);
    folder.run(&["verify", "d.toml", "-o", "c.json"]);
    folder.run(&["check", "c.json", "--sample", "3"]).exits(2).complains(&["accepted: a paving"]);
}

/// The paper's prototype, with an offset.
const CUBE: &str = "[mechanism]\nkind = \"orthoglide\"\noffset = 7\n[workspace]\ncube = 200\n\
                    [requirements]\ntransmission = { max = 2 }\n";

#[test]
fn a_box_in_the_place_of_the_workspace_takes_any_design() {
    let folder = Folder::new();
    folder.write("cube.toml", CUBE);
    let refused = folder.run(&["pave", "cube.toml"]).exits(2);
    refused.complains(&["workspace.cube: found a cube", "--box X0,X1,Y0,Y1,Z0,Z1"]);
    // A hair within the paper's cube, all of it is inner; beyond Q_1 and Q_2, not.
    let within = "-73.2,126.79,-73.2,126.79,-73.2,126.79";
    let pave = |range: &str, to: &str| {
        let options = ["--precision", "20", "-o", to, "--format", "json", "--box", range];
        let run = folder.run(&[&["pave", "cube.toml"], &options[..]].concat());
        let answer: Value = serde_json::from_str(&run.exits(0).stdout).unwrap();
        answer["inner"]["share"].as_str().unwrap().to_owned()
    };
    let share = |text: String| {
        let (p, q) = text.split_once('/').unwrap_or((&text, "1"));
        p.parse::<f64>().unwrap() / q.parse::<f64>().unwrap()
    };
    let inner = share(pave(within, "a.paving"));
    assert!(inner > 0.99, "{inner}");
    let check = folder.run(&["check", "a.paving"]).exits(0);
    check.says(&["ACCEPTED: paving", "psi_i >= 0.5", "126.79"]);
    folder.run(&["check", "a.paving", "--design", "cube.toml"]).exits(5);
    assert!(share(pave("-250,250,-250,250,-250,250", "b.paving")) < 0.7);
    // Just beyond Q_2 = (126.794.., 126.794.., 126.794..) there is none.
    assert_eq!(share(pave("126.8,127,126.8,127,126.8,127", "c.paving")), 0.0);
    // The ends are exact numbers; the design's own box is replaced.
    folder.write("d.toml", DESIGN);
    let half = ["pave", "d.toml", "--precision", "0.2", "--box", "0,sqrt(2)/4,0,1/3,-0.1,1e-1"];
    folder.run(&half).exits(0);
    folder.run(&["check", "d.paving"]).exits(0).says(&["sqrt(2)", "1/3", "-0.1"]);
}

#[test]
fn a_cylinder_is_searched_in_a_box() {
    let folder = Folder::with(&["linear-delta-klipper-cylinder.toml"]);
    let design = "linear-delta-klipper-cylinder.toml";
    folder.run(&["pave", design]).exits(2).complains(&["--box"]);
    let run = folder.run(&["pave", design, "--box", "-60,60,-60,60,0,50", "--precision", "15"]);
    run.exits(0).says(&["inner"]);
    let check = ["check", "linear-delta-klipper-cylinder.paving", "--design", design];
    folder.run(&check).exits(5).complains(&["another claim", "cylinder"]);
    let of = |range| folder.run(&[&check[..], &["--box", range]].concat());
    of("-60,60,-60,60,0,50").exits(0).says(&["ACCEPTED"]);
    of("-60,60,-60,60,0,51").exits(5).complains(&["another claim"]);
    folder.run(&["check", "linear-delta-klipper-cylinder.paving"]).exits(0);
}

#[test]
fn boxes_that_are_none_are_refused() {
    let folder = folder();
    for (range, complaint) in [
        ("0,1,0,1,0", "six numbers"),
        ("0,1,0,1,0,1,2", "six numbers"),
        ("0,1,0,x,0,1", "is not a number"),
        ("0,1,0,,0,1", "is not a number"),
        ("0,1,1,1,0,1", "along y the first number is not less"),
        ("0,1,0,1,2,1", "along z the first number is not less"),
    ] {
        let run = folder.run(&["pave", "d.toml", "--box", range]).exits(2);
        run.complains(&["--box", complaint]);
    }
    assert_eq!(folder.names(), ["d.toml"]);
}

#[test]
fn joints_that_move_alone_along_an_axis_are_told_apart_on_it() {
    // On vertical guides M does not depend on z; the joint coordinates do.
    let folder = Folder::new();
    let design = folder.run(&["init", "--kind", "linear-delta"]).exits(0).stdout;
    assert!(design.contains("joint_range"), "{design}");
    folder.write("d.toml", design);
    let range =
        ["--box", "-150,150,-150,150,0,300", "--volume-gap", "0.3", "--max-boxes", "100000"];
    folder.run(&[&["pave", "d.toml"][..], &range].concat()).exits(0).says(&["inner"]);
}

/// A five-bar, as a point in the plane; a machine of formulas with a tolerance; a requirement beyond
/// velocity on a machine with four legs.
const OTHERS: [(&str, &str, &str); 3] = [
    (
        "five-bar",
        r#"
    [mechanism]
    kind = "planar"
    [[mechanism.legs]]
    drive = "strut"
    anchor = [0, 0]
    [[mechanism.legs]]
    drive = "strut"
    anchor = [1, 0]
    [workspace]
    min = [-1, 0.1]
    max = [2, 2]
    [requirements]
    transmission = { min = "1/2", max = 2 }
    conditioning = { max = 3 }
"#,
        "0,1,0.1,1",
    ),
    (
        "formulas",
        r#"
    [mechanism]
    kind = "formulas"
    coordinates = ["x", "y"]
    [mechanism.parameters]
    l = "200 +/- 0.05"
    [mechanism.definitions]
    s = "sqrt(l^2 - y^2)"
    [[mechanism.joints]]
    rho = "x - s"
    [[mechanism.joints]]
    rho = "x + s"
    [workspace]
    min = [-100, -300]
    max = [100, 300]
    [requirements]
    transmission = { max = 2 }
"#,
        "0,1,100,150",
    ),
    (
        "four legs",
        r#"
    [mechanism]
    kind = "translational"
    [[mechanism.legs]]
    drive = "strut"
    anchor = [1, 0, 0]
    [[mechanism.legs]]
    drive = "strut"
    anchor = [-1, 0, 0]
    [[mechanism.legs]]
    drive = "strut"
    anchor = [0, 1, 0]
    [[mechanism.legs]]
    drive = "strut"
    anchor = [0, -1, 0]
    [workspace]
    min = [-0.5, -0.5, 0.3]
    max = [0.5, 0.5, 1.5]
    [requirements]
    stiffness = { joint = 50, min = 20 }
"#,
        "0,1,0,1,0.3,1",
    ),
];

#[test]
fn machines_of_every_kind_that_do_not_turn_are_paved() {
    for (name, design, range) in OTHERS {
        let folder = Folder::new();
        folder.write("d.toml", design);
        let pave = ["pave", "d.toml", "--volume-gap", "0.3", "--max-boxes", "100000"];
        folder.run(&pave).exits(0).says(&["volume: between", "inner"]);
        let first = folder.read("d.paving");
        let check = ["check", "d.paving", "--design", "d.toml"];
        folder.run(&check).exits(0).says(&["ACCEPTED: paving"]);
        folder.run(&[&check[..], &["--sample", "9"]].concat()).exits(0);
        folder.run(&["report", "d.paving"]).exits(0);
        folder.run(&["export", "stl", "d.paving", "-o", "d.stl"]).exits(0);
        let json = [&pave[..], &["--threads", "3", "--format", "json"]].concat();
        let answer: Value = serde_json::from_str(&folder.run(&json).exits(0).stdout).unwrap();
        let coordinates = range.split(',').count() / 2;
        let at = answer["components"]["best_conditioned_at"].as_array().unwrap();
        assert_eq!(at.len(), coordinates, "{name}");
        assert!(folder.read("d.paving") == first, "{name}");
        let more = ["pave", "d.toml", "--precision", "50", "--box", range, "-o", "box.paving"];
        folder.run(&more).exits(0);
        folder.run(&["check", "box.paving"]).exits(0);
        let wrong = folder.run(&["pave", "d.toml", "--box", "0,1,0"]).exits(2);
        wrong.complains(&["--box: found 0,1,0; accepted: "]);
    }
}

#[test]
fn machines_that_turn_are_refused_unless_it_is_said_what_is_paved() {
    let folder = Folder::new();
    let design = folder.run(&["init", "--kind", "planar"]).exits(0).stdout;
    folder.write("d.toml", design);
    folder.run(&["pave", "d.toml"]).exits(2).complains(&["without orientation, or --coordinates"]);
    assert_eq!(folder.names(), ["d.toml"]);
}

#[test]
fn files_given_to_the_wrong_command_name_the_right_one() {
    let folder = Folder::new();
    folder.write("d.toml", DESIGN);
    for command in ["check", "show", "report"] {
        folder
            .run(&[command, "d.toml"])
            .exits(5)
            .complains(&["this is a design: `orthocert verify d.toml`"]);
    }
}

/// The factors of the Orthoglide of length 1 at a point, squared, nearly: the rows of `M` are those of `A`,
/// `(p - rho_i e_i)`, over `eta_i`, and `psi^2` is 1 over an eigenvalue of `M^T M`.
fn eigenvalues(p: [f64; 3]) -> Option<[f64; 2]> {
    let entry = |i: usize, j: usize| {
        let square: f64 = (0..3).filter(|&k| k != i).map(|k| p[k] * p[k]).sum();
        let eta = (1.0 - square).sqrt();
        if i == j {
            1.0
        } else {
            p[j] / eta
        }
    };
    let m = nalgebra::Matrix3::from_fn(entry);
    let all = (m.transpose() * m).symmetric_eigenvalues();
    all.iter().all(|x| x.is_finite()).then(|| [all.min(), all.max()])
}

/// Points on both sides of the planes that cut boxes, checked by formulas of their own; planes that are moved
/// by their distance, either way, so that one side has points of the other, are refused.
#[test]
fn planes_that_cut_boxes_are_where_the_requirements_end() {
    let folder = folder();
    folder.run(&["pave", "d.toml", "--volume-gap", "0.03"]).exits(0).says(&["planes"]);
    let bytes = folder.read("d.paving");
    let mut reader = Reader::new(&bytes[..]).unwrap();
    let (mut cuts, mut points) = (Vec::new(), [0; 2]);
    while let Some(visited) = reader.next().unwrap() {
        let Kind::Cut(cut) = &visited.item.kind else { continue };
        let n: Vec<f64> = cut.normal.iter().map(|n| *n as f64).collect();
        for at in 0..1000 {
            let u = [0, 1, 2].map(|k| (at / 10i32.pow(k) % 10) as f64 / 4.5 - 1.0);
            let p = [0, 1, 2].map(|k| {
                let edge = visited.cell.edges[k];
                let part = (edge.index() as f64 + 0.5 + 0.5 * u[k]) / (1u64 << edge.level()) as f64;
                -0.7 + 1.4 * part
            });
            let along: f64 = n.iter().zip(u).map(|(n, u)| n * u).sum();
            let holds = eigenvalues(p).is_some_and(|[least, most]| least >= 0.25 && most <= 4.0);
            if along <= cut.ends[0] as f64 {
                assert!(holds, "{p:?} is not inner");
                points[0] += 1;
            } else if along >= cut.ends[1] as f64 {
                assert!(!holds, "{p:?} is not outer");
                points[1] += 1;
            }
        }
        cuts.push(visited.clone());
    }
    assert!(cuts.len() > 1000 && points.iter().all(|n| *n > 100_000), "{} {points:?}", cuts.len());
    let subject = Subject::new(reader.header()).unwrap();
    let judge = Judge::new(&subject).unwrap();
    let mut refused = 0;
    for visited in cuts {
        let Kind::Cut(cut) = &visited.item.kind else { continue };
        let [inner, outer] = cut.ends;
        let all: i64 = cut.normal.iter().map(|n| n.abs()).sum();
        let width = outer - inner;
        for ends in [[outer + width, outer + width], [inner - width, inner - width]] {
            // Where there is something of both sides.
            if inner <= -all || outer >= all || ends[0].abs() >= all {
                continue;
            }
            let kind = Kind::Cut(Cut { ends, ..cut.clone() });
            let item = Item { steps: Vec::new(), kind };
            assert!(!judge.confirms(&visited.cell, visited.inherited, &item), "{cut:?} {ends:?}");
            refused += 1;
        }
    }
    assert!(refused > 500, "{refused}");
}
