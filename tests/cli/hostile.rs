//! Folders and names of strangers: nothing is waited for, nothing of somebody else's is written to,
//! and no name does anything but stand there.
#![cfg(unix)]

use crate::atlas::{coarse, map};
use crate::junit;
use crate::support::{Folder, Run};
use orthocert::files::shown::is_unseen;
use std::fs;
use std::os::unix::fs::symlink;
use std::os::unix::net::UnixListener;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const DESIGN: &str = "orthoglide-312.toml";
/// An escape, line breaks, marks of direction, what is no character, and commands to a runner.
const NAME: &str = "::error::\u{1b}[2J\n::error::\r\u{202e}\u{2066}\u{2028}\u{9b}\u{ffff}##[x]@a";

/// Runs the binary; that it does not end turns into a failure.
fn run(folder: &Folder, arguments: &[&str]) -> Run {
    let mut command = folder.command(arguments);
    let piped = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = piped.spawn().unwrap();
    // Held open: what waits for standard input waits for ever.
    let _input = child.stdin.take();
    let started = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if started.elapsed() > Duration::from_secs(60) {
            child.kill().unwrap();
            panic!("{arguments:?} does not end");
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    child.wait_with_output().unwrap().into()
}

/// What is no file, under these names.
fn traps(folder: &Folder, [pipe, device, socket, endless]: [&str; 4]) {
    assert!(Command::new("mkfifo").arg(folder.path(pipe)).status().unwrap().success());
    symlink("/dev/zero", folder.path(device)).unwrap();
    UnixListener::bind(folder.path(socket)).unwrap();
    fs::File::create(folder.path(endless)).unwrap().set_len(1 << 40).unwrap();
}

#[test]
fn numbers_beyond_doubles_do_not_keep_a_search_from_ending() {
    let folder = Folder::new();
    for (old, new) in [
        ("ca = \"(1 - s^2)/(1 + s^2)\"", "ca = \"(1 - s^2)/(1e310 + s^2)\""),
        ("sb*r - cb*platform/2", "sb*r - cb*platform/1e310"),
    ] {
        folder.write("d.toml", crate::for_all::design("tricept", &[(old, new)]));
        let found = run(&folder, &["verify", "d.toml", "--timeout", "1"]);
        assert!(matches!(found.code, Some(1 | 3)), "{new}: {}", found.stderr);
    }
}

#[test]
fn a_folder_of_designs_that_are_no_files_is_not_waited_for() {
    let folder = Folder::with(&[DESIGN]);
    traps(&folder, ["b.toml", "c.toml", "d.toml", "e.toml"]);
    let found = run(&folder, &["verify", "."]).exits(2);
    let lines = |word: &str| found.stdout.lines().filter(|line| line.starts_with(word)).count();
    assert_eq!((lines("CERTIFIED"), lines("BAD INPUT")), (1, 4), "{}", found.stdout);
    assert_eq!(found.stdout.matches("no regular file").count(), 3, "{}", found.stdout);
    let of_last = |line: &str| line.contains("e.toml") && line.contains("more than 1048576 bytes");
    assert!(found.stdout.lines().any(of_last), "{}", found.stdout);
}

#[test]
fn a_folder_of_certificates_that_are_no_files_is_not_waited_for() {
    let folder = Folder::new();
    fs::copy(Folder::with(&[DESIGN]).path(DESIGN), folder.path("z.toml")).unwrap();
    let design = folder.read("z.toml");
    run(&folder, &["verify", "z.toml"]).exits(0);
    for name in ["a.toml", "b.toml", "c.toml", "d.toml"] {
        folder.write(name, &design);
    }
    traps(&folder, ["a.cert.json", "b.cert.json", "c.cert.json", "d.cert.json"]);
    for command in ["check", "verify"] {
        let found = run(&folder, &[command, "."]).exits(2);
        assert_eq!(found.stdout.matches("no regular file").count(), 3, "{}", found.stdout);
        let accepted = found.stdout.lines().find(|line| line.contains("z.")).unwrap();
        assert!(accepted.contains("CERTIFIED") || accepted.contains("ACCEPTED"), "{accepted}");
    }
}

#[test]
fn no_command_waits_for_what_is_no_file() {
    let folder = Folder::with(&[DESIGN]);
    run(&folder, &["verify", DESIGN, "-o", "c.json"]).exits(0);
    traps(&folder, ["pipe", "device", "socket", "endless"]);
    fs::create_dir(folder.path("job")).unwrap();
    symlink("../pipe", folder.path("job/job.json")).unwrap();
    for trap in ["pipe", "device", "socket", "endless"] {
        let commands: &[&[&str]] = &[
            &["verify", trap],
            &["check", trap],
            &["check", trap, "--design", DESIGN],
            &["check", "c.json", "--design", trap],
            &["attest", trap, "--design", DESIGN],
            &["attest", "c.json", "--design", trap],
            &["show", trap],
            &["report", trap],
            &["bounds", trap],
            &["pave", trap],
            &["atlas", trap, "-o", "map"],
            &["split", trap, "--shards", "2", "--out", "shards"],
            &["run-shard", trap],
            &["largest-cube", trap],
            &["limit", trap, "mechanism.leg_length"],
            &["tolerance", trap],
            &["size", trap, "--cube", "10"],
            &["import", "klipper", trap],
            &["import", "linuxcnc", trap],
            &["export", "rocq", trap],
            &["export", "vtk", trap, "-o", "x.vtu"],
            &["export", "stl", trap, "-o", "x.stl"],
            &["merge", "job", "-o", "whole"],
            &["submit", "job", "--engine", "slurm", "-o", "whole"],
        ];
        for arguments in commands {
            let found = run(&folder, arguments);
            // A certificate that is too large is rejected as such.
            let large = trap == "endless"
                && ["check", "show", "attest", "report", "export"].contains(&arguments[0]);
            let code = found.code.unwrap();
            assert!(code == 2 || large && code == 5, "{arguments:?}: {}", found.stderr);
            assert_eq!(
                found.stderr.trim_end().lines().count(),
                1,
                "{arguments:?}: {}",
                found.stderr
            );
        }
    }
}

#[test]
fn what_the_caller_has_opened_is_read() {
    let folder = Folder::with(&[DESIGN]);
    run(&folder, &["verify", DESIGN, "-o", "c.json"]).exits(0);
    let mut command = folder.command(&["check", "/dev/stdin", "--design", DESIGN]);
    let input = fs::File::open(folder.path("c.json")).unwrap();
    Run::from(command.stdin(input).output().unwrap()).exits(0).says(&["ACCEPTED"]);
}

#[test]
fn nothing_is_written_through_a_link() {
    let folder = Folder::with(&[DESIGN]);
    folder.write("victim.txt", "of somebody else");
    fs::create_dir(folder.path("repo")).unwrap();
    fs::rename(folder.path(DESIGN), folder.path("repo/a.toml")).unwrap();
    run(&folder, &["verify", "repo/a.toml", "-o", "c.json"]).exits(0);
    for target in ["../victim.txt", "../absent"] {
        symlink(target, folder.path("repo/a.cert.json")).unwrap();
        let link = "repo/a.cert.json";
        let refused: &[&[&str]] = &[
            &["verify", "repo"],
            &["verify", "repo/a.toml"],
            &["verify", "repo/a.toml", "-o", link],
            &["verify", "repo", "--junit", link],
            &["verify", "repo", "--sarif", link],
            &["verify", "repo", "--summary", link],
            &["attest", "c.json", "--design", "repo/a.toml", "-o", link],
            &["report", "c.json", "-o", link],
            &["export", "rocq", "c.json", "-o", link],
            &["postulate", "--psi", "2", "-o", link],
        ];
        for arguments in refused {
            let found = run(&folder, arguments).exits(4);
            let said = found.stdout + &found.stderr;
            assert!(said.contains("a symbolic link"), "{arguments:?}: {said}");
        }
        assert!(folder.read("victim.txt") == b"of somebody else");
        assert!(!folder.path("absent").exists());
        fs::remove_file(folder.path(link)).unwrap();
    }
    symlink("../victim.txt", folder.path("repo/a.cert.json")).unwrap();
    run(&folder, &["verify", "repo", "--follow-links"]).exits(0);
    run(&folder, &["check", "victim.txt"]).exits(0);
    assert!(fs::symlink_metadata(folder.path("repo/a.cert.json")).unwrap().is_symlink());
}

#[test]
fn nothing_is_written_into_a_linked_folder_below_the_one_that_is_named() {
    let folder = Folder::with(&[DESIGN]);
    for name in ["designs/sub", "out", "elsewhere"] {
        fs::create_dir_all(folder.path(name)).unwrap();
    }
    fs::rename(folder.path(DESIGN), folder.path("designs/sub/a.toml")).unwrap();
    symlink("../elsewhere", folder.path("out/sub")).unwrap();
    symlink("elsewhere", folder.path("link")).unwrap();
    let certificate = "elsewhere/a.cert.json";
    run(&folder, &["verify", "designs/sub/a.toml", "-o", "c.json"]).exits(0);
    let refused: &[&[&str]] = &[
        &["verify", "designs", "--out", "out"],
        &["verify", "designs", "--out", "link"],
        &["verify", "designs", "--out", "link/"],
        &["report", "c.json", "-o", "r.html", "--svg", "link"],
        &["bounds", "designs/sub/a.toml", "-o", "link", "--relative", "0.1"],
        &["atlas", "map.toml", "-o", "link"],
        &["split", "map.toml", "--shards", "1", "--out", "link"],
    ];
    folder.write("map.toml", coarse().read("map.toml"));
    for arguments in refused {
        let found = run(&folder, arguments).exits(4);
        let said = found.stdout + &found.stderr;
        assert!(said.contains("symbolic link"), "{arguments:?}: {said}");
        assert_eq!(fs::read_dir(folder.path("elsewhere")).unwrap().count(), 0, "{arguments:?}");
    }
    run(&folder, &["verify", "designs", "--out", "out", "--follow-links"]).exits(0);
    assert!(folder.path(certificate).exists());
}

#[test]
fn nothing_is_written_through_the_links_of_a_jobs_engine() {
    let folder = coarse();
    run(&folder, &["split", "map.toml", "--shards", "2", "--out", "job"]).exits(0);
    let submit = ["submit", "job", "--engine", "slurm", "-o", "whole", "--scripts-only"];
    folder.write("victim", "of somebody else");
    fs::create_dir(folder.path("elsewhere")).unwrap();
    symlink("../elsewhere", folder.path("job/engine")).unwrap();
    run(&folder, &submit).exits(4).complains(&["symbolic link"]);
    fs::remove_file(folder.path("job/engine")).unwrap();
    fs::create_dir(folder.path("job/engine")).unwrap();
    // The engine would follow that of a log.
    for name in ["task.sh", "array.sbatch", "1.log"] {
        let path = folder.path(&format!("job/engine/{name}"));
        symlink("../../victim", &path).unwrap();
        run(&folder, &submit).exits(4).complains(&[name, "symbolic link"]);
        fs::remove_file(&path).unwrap();
    }
    assert!(folder.read("victim") == b"of somebody else");
    assert_eq!(fs::read_dir(folder.path("elsewhere")).unwrap().count(), 0);
    run(&folder, &submit).exits(0);
}

#[test]
fn no_path_ends_the_quotes_of_an_engines_options() {
    let folder = coarse();
    for name in ["a\" --wrap=x", "a\\", "a\u{1b}", "a\u{202e}b", "a\nb"] {
        fs::create_dir(folder.path(name)).unwrap();
        let job = format!("{name}/job");
        run(&folder, &["split", "map.toml", "--shards", "1", "--out", &job]).exits(0);
        let submit = ["submit", &job, "--engine", "slurm", "-o", "whole", "--scripts-only"];
        let found = run(&folder, &submit).exits(2);
        seen(&found);
        assert!(!folder.path(&job).join("engine").exists());
    }
}

/// Holds that everything printed is seen, is on lines of this program's own, and commands nothing.
fn seen(found: &Run) {
    for text in [&found.stdout, &found.stderr] {
        let unseen = text.chars().find(|c| is_unseen(*c) && *c != '\n');
        assert_eq!(unseen, None, "{text:?}");
        assert!(!text.contains("##["), "{text}");
        // What follows the name's first line break begins no line, escaped or not.
        let begins = ["::", "\\u{3a}:error::\\r"];
        let forged = |line: &str| begins.iter().any(|begin| line.trim_start().starts_with(begin));
        assert!(!text.lines().any(forged), "{text}");
    }
}

#[test]
fn names_do_nothing_in_any_commands_output() {
    let folder = Folder::with(&[DESIGN]);
    let name = |ending: &str| format!("{NAME}{ending}");
    let (toml, cert, paving) = (name(".toml"), name(".cert.json"), name(".paving"));
    let design = String::from_utf8(folder.read(DESIGN)).unwrap();
    folder.write(&toml, design.replacen("title = \"", "title = \"\u{202e}@x $y$ ", 1));
    folder.write(&name(".bad.toml"), "\"a\\nb\u{202e}\" = 1\n[mechanism");
    folder.write("bad.cert.json", "{");
    folder.write("bad.toml", format!("title = '''\n::error::{NAME}'''\n[x]\n"));
    fs::create_dir(folder.path("sub")).unwrap();
    let (out, missing) = (name(".out"), name(".missing"));
    let commands: &[(&[&str], i32)] = &[
        (&["verify", &toml], 0),
        (&["verify", &toml, "--format", "json"], 0),
        (&["verify", "."], 2),
        (&["verify", ".", "--format", "json"], 2),
        (&["verify", &toml, "-o", "sub"], 4),
        (&["verify", &missing], 2),
        (&["verify", "bad.toml"], 2),
        (&["check", &cert], 0),
        (&["check", "."], 2),
        (&["check", ".", "--format", "json"], 2),
        (&["check", &toml], 5),
        (&["check", &missing], 2),
        (&["attest", &cert, "--design", &toml], 0),
        (&["attest", &cert, "--design", &toml, "-o", &out], 0),
        (&["show", &missing], 2),
        (&["show", &toml], 5),
        (&["report", &cert, "--title", NAME], 0),
        (&["report", &toml], 5),
        (&["pave", &toml, "--volume-gap", "0.9", "-o", &paving], 0),
        (&["pave", &toml, "-o", "."], 2),
        (&["check", &paving], 0),
        (&["report", &paving], 0),
        (&["export", "vtk", &paving, "-o", &out], 0),
        (&["export", "rocq", &toml], 5),
        (&["export", "rocq", &paving], 2),
        (&["bounds", &missing], 2),
        (&["atlas", &toml], 2),
        (&["split", &missing, "--shards", "1", "--out", &out], 2),
        (&["run-shard", &toml], 2),
        (&["merge", ".", "-o", &out], 2),
        (&["import", "klipper", &toml], 2),
        (&["size", &missing, "--cube", "1"], 2),
        // The parser of the command line quotes what it does not take.
        (&[NAME], 2),
        (&["verify", NAME, &format!("--{NAME}")], 2),
        (&["verify", "--jobs", NAME], 2),
        (&["init", "--kind", NAME], 2),
        (&["postulate", "--psi", NAME], 2),
        (&["pave", &toml, "--box", NAME], 2),
        (&["pave", &toml, "--precision", NAME], 2),
        (&["verify", &toml, "--timeout", NAME], 2),
        (&["largest-cube", &toml, "--side", NAME], 2),
    ];
    for (arguments, code) in commands {
        let found = run(&folder, arguments);
        seen(&found);
        assert_eq!(found.code, Some(*code), "{arguments:?}: {}", found.stderr);
        let _ = fs::remove_file(folder.path(&out));
    }
}

#[test]
fn names_and_titles_do_nothing_in_reports() {
    let folder = Folder::new();
    let stranger = "\u{ffff}\u{202e}</text> https://evil.example www.evil.example @name $x$ #1 ]]>";
    let map = String::from_utf8(map(1).read("map.toml")).unwrap();
    let label = format!("label = \"{}\"", &stranger[..20].replace('"', ""));
    let (before, after) = map.split_once("label = \"").unwrap();
    let (_, after) = after.split_once('"').unwrap();
    folder.write("map.toml", format!("{before}{label}{after}"));
    run(&folder, &["atlas", "map.toml", "-o", "map"]).exits(0);
    let svg = String::from_utf8(folder.read("map/map.svg")).unwrap();
    roxmltree::Document::parse(&svg).unwrap();
    let page = String::from_utf8(folder.read("map/index.html")).unwrap();
    assert!(![svg, page].iter().any(|text| text.chars().any(|c| is_unseen(c) && c != '\n')));

    let design = String::from_utf8(Folder::with(&[DESIGN]).read(DESIGN)).unwrap();
    let (_, rest) = design.split_once("[mechanism]").unwrap();
    folder.write(&format!("{NAME}.toml"), format!("title = '{stranger}'\n[mechanism]{rest}"));
    folder.write(&format!("{NAME}.bad.toml"), "x");
    fs::remove_file(folder.path("map.toml")).unwrap();
    let mut command =
        folder.command(&["verify", ".", "--junit", "j", "--sarif", "s", "--summary", "m"]);
    command.env("GITHUB_ACTIONS", "true").env_remove("GITHUB_STEP_SUMMARY");
    let found = Run::from(command.output().unwrap()).exits(2);
    let told: Vec<_> = found.stderr.lines().filter(|line| line.starts_with("::")).collect();
    assert_eq!(told.len(), 1, "{told:?}");
    let read = |name: &str| String::from_utf8(folder.read(name)).unwrap();
    for text in [read("j"), read("s"), read("m"), found.stdout.clone(), found.stderr.clone()] {
        assert!(!text.chars().any(|c| is_unseen(c) && c != '\n'), "{text:?}");
    }
    junit::valid(&junit::read(&read("j")));
    let _: serde_json::Value = serde_json::from_str(&read("s")).unwrap();
    // Without the code, nothing of the strangers' is left.
    for row in read("m").lines().filter(|line| line.contains("evil") || line.contains("@a")) {
        let plain = without_code(row);
        assert!(!plain.contains(['@', '$', ':', '#']) && !plain.contains("www"), "{row}");
    }
}

/// A line of Markdown without its spans of code.
fn without_code(line: &str) -> String {
    let mut out = String::new();
    let mut rest = line;
    while let Some((before, after)) = rest.split_once('`') {
        out += before;
        let more = after.len() - after.trim_start_matches('`').len();
        let fence = "`".repeat(more + 1);
        (_, rest) = after[more..].split_once(&fence).unwrap();
    }
    out + rest
}
