//! Signals, closed and full outputs: exit 4, nothing half-written.
#![cfg(target_os = "linux")]

use crate::support::{Folder, Run, LONG};
use orthocert_kernel::paving::{Item, Kind};
use orthocert_kernel::prover::write_pair;
use std::fs::{self, File};
use std::io::Write;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

/// Starts a search that ends for no other reason than a signal.
fn started(folder: &Folder) -> Child {
    let arguments = ["verify", LONG, "--max-boxes", "2000000", "--threads", "1"];
    let mut command = folder.command(&arguments);
    command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Waits until the process catches the signal, by its mask of caught signals.
fn wait_until_caught(child: &mut Child, signal: u32) {
    while child.try_wait().unwrap().is_none() {
        let status = fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap();
        let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:")).unwrap();
        let mask = u64::from_str_radix(caught.trim(), 16).unwrap();
        if mask & (1 << (signal - 1)) != 0 {
            return;
        }
        sleep(Duration::from_millis(1));
    }
}

fn send(child: &Child, signal: u32) {
    let kill = format!("kill -{signal} {}", child.id());
    assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
}

#[test]
fn signals_end_a_long_search_with_exit_4() {
    const SIGINT: u32 = 2;
    const SIGTERM: u32 = 15;
    for signal in [SIGINT, SIGTERM] {
        let folder = Folder::with(&[LONG]);
        let mut child = started(&folder);
        wait_until_caught(&mut child, signal);
        send(&child, signal);
        let run = Run::from(child.wait_with_output().unwrap()).exits(4);
        run.complains(&["interrupted"]);
        assert_eq!(folder.names(), [LONG]);
    }
}

#[test]
fn an_interrupted_run_keeps_the_certificate_that_was_there() {
    let folder = Folder::with(&[LONG]);
    let certificate = LONG.replace(".toml", ".cert.json");
    folder.write(&certificate, "earlier");
    let mut child = started(&folder);
    wait_until_caught(&mut child, 2);
    send(&child, 2);
    Run::from(child.wait_with_output().unwrap()).exits(4);
    assert_eq!(folder.read(&certificate), b"earlier");
}

#[test]
fn interrupted_bounds_tell_what_was_enclosed() {
    for threads in ["1", "2"] {
        let folder = Folder::new();
        folder.write("d.toml", include_str!("../designs/kernel/hexapod-forces.toml"));
        let arguments = ["bounds", "d.toml", "-o", ".", "--relative", "0.1", "--threads", threads];
        let mut command = folder.command(&arguments);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        // The certificates of the first row, of which this is the last.
        while !folder.path("psi-least-outer.cert.json").is_file() {
            assert!(child.try_wait().unwrap().is_none(), "ended before it was interrupted");
            sleep(Duration::from_millis(1));
        }
        send(&child, 2);
        let run = Run::from(child.wait_with_output().unwrap()).exits(4);
        assert!(run.stderr.contains("interrupted"), "{}", run.stderr);
        let first = run.stdout.lines().find(|line| line.starts_with("  psi"));
        assert!(first.is_some_and(|line| line.contains("least     0.4")), "{}", run.stdout);
        run.says(&["joint force, force greatest interrupted", "PARTIAL"]);
    }
}

#[test]
fn an_interrupted_limit_writes_nothing() {
    let folder = Folder::with(&[LONG]);
    let arguments = ["limit", LONG, "mechanism.parameters.l", "--gap", "1e-9", "--threads", "1"];
    let mut command = folder.command(&arguments);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    wait_until_caught(&mut child, 2);
    send(&child, 2);
    Run::from(child.wait_with_output().unwrap()).exits(4).complains(&["interrupted"]);
    assert_eq!(folder.names(), [LONG]);
}

/// What was found before a signal is printed, or there was nothing yet; never a verdict of the whole.
#[test]
fn interrupted_answers_tell_what_was_found_and_exit_with_4() {
    let design = "orthoglide-as-built.toml";
    let commands: [&[&str]; 4] = [
        &["limit", design, "workspace.max.0", "--gap", "1e-9"],
        &["largest-cube", design, "--gap", "1e-9"],
        &["summary", design, "--gap", "1e-9"],
        &["tolerance", design, "--gap", "1e-6"],
    ];
    let runs = commands.into_iter().flat_map(|command| ["1", "2"].map(|n| (command, n)));
    for (arguments, threads) in runs {
        let folder = Folder::with(&[design]);
        let mut command = folder.command(&[arguments, &["--threads", threads]].concat());
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        wait_until_caught(&mut child, 2);
        sleep(Duration::from_millis(300));
        send(&child, 2);
        let run = Run::from(child.wait_with_output().unwrap()).exits(4);
        assert!(run.stderr.contains("interrupted"), "{}", run.stderr);
        assert!(
            run.stdout.is_empty() || run.stdout.contains("PARTIAL: interrupted"),
            "{arguments:?}"
        );
    }
}

/// Runs an atlas until what it keeps has so many bytes, then sends a signal; what it said, if it did not
/// end before.
fn interrupted_atlas(folder: &Folder, more: &[&str], bytes: u64, signal: u32) -> Option<Run> {
    let mut command = folder.command(&[&["atlas", "map.toml", "--threads", "1"], more].concat());
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let part = folder.path("map.atlas.part");
    while fs::metadata(&part).map_or(0, |file| file.len()) < bytes {
        if child.try_wait().unwrap().is_some() {
            return None;
        }
        sleep(Duration::from_millis(1));
    }
    send(&child, signal);
    Some(Run::from(child.wait_with_output().unwrap()))
}

#[test]
fn a_map_that_was_interrupted_is_taken_up_to_the_same_bytes() {
    const SIGKILL: u32 = 9;
    let whole = crate::atlas::coarse();
    whole.run(&["atlas", "map.toml"]).exits(0);
    assert_eq!(whole.names(), ["map.atlas", "map.toml"]);
    let folder = crate::atlas::coarse();
    let mut more: &[&str] = &[];
    let mut interrupted = 0;
    for (bytes, signal) in [(1, 2), (2_000, SIGKILL), (5_000, 2), (10_000, SIGKILL)] {
        let Some(run) = interrupted_atlas(&folder, more, bytes, signal) else { break };
        if signal == 2 {
            run.exits(4).complains(&[
                "interrupted",
                "map.atlas.part holds what is done",
                "--resume",
            ]);
        }
        assert_eq!(folder.names(), ["map.atlas.part", "map.toml"]);
        (more, interrupted) = (&["--resume"], interrupted + 1);
        // As a run leaves it that is killed while it writes.
        let mut part = File::options().append(true).open(folder.path("map.atlas.part")).unwrap();
        part.write_all(b"{\"sha256\":\"0").unwrap();
    }
    assert!(interrupted > 1, "{interrupted}");
    if folder.path("map.atlas.part").exists() {
        folder.run(&["atlas", "map.toml", "--resume"]).exits(0);
    }
    assert_eq!(folder.names(), ["map.atlas", "map.toml"]);
    for file in ["atlas.cert.json", "best.cert.json", "map.svg", "index.html", "SHA256SUMS"] {
        let file = format!("map.atlas/{file}");
        assert_eq!(folder.read(&file), whole.read(&file), "{file}");
    }
}

#[test]
fn a_map_out_of_time_exits_3_and_only_its_own_part_is_taken_up() {
    let folder = crate::atlas::coarse();
    let run = folder.run(&["atlas", "map.toml", "--timeout", "0"]).exits(3);
    run.complains(&["the time was up", "map.atlas.part holds what is done, 0 cells", "--resume"]);
    let text = String::from_utf8(folder.read("map.toml")).unwrap();
    let own = folder.read("map.atlas.part");
    for (from, to) in [("resolution = 4", "resolution = 3"), ("max = 4,", "max = 5,")] {
        assert!(text.contains(from));
        let text = text.replace(from, to);
        folder.write("other.toml", &text);
        folder.write("other.atlas.part", &own);
        let run = folder.run(&["atlas", "other.toml", "--resume"]);
        run.exits(2).complains(&["other.atlas.part", "the map of another design"]);
    }
    folder.write("other.atlas.part", "notes");
    for more in [&[][..], &["--resume"]] {
        let run = folder.run(&[&["atlas", "other.toml"], more].concat()).exits(2);
        run.complains(&["other.atlas.part", "no unfinished map"]);
    }
    assert_eq!(folder.read("other.atlas.part"), b"notes");
    let run = folder.run(&["atlas", "map.toml", "-o", "elsewhere", "--resume"]).exits(2);
    run.complains(&["--resume", "elsewhere.part"]);
    let run = folder.run(&["atlas", "map.toml"]).exits(0);
    assert!(run.stderr.contains("is not taken up: --resume would"), "{}", run.stderr);
}

#[test]
fn a_paving_that_was_interrupted_is_taken_up_to_the_same_bytes() {
    let folder = Folder::new();
    folder.write("d.toml", crate::paving::DESIGN);
    let pave = ["pave", "d.toml", "--volume-gap", "0.01", "--threads", "1"];
    let mut command = folder.command(&pave);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let part = folder.path("d.paving.part");
    while fs::metadata(&part).map_or(0, |file| file.len()) < 10_000 {
        assert!(child.try_wait().unwrap().is_none(), "ended before it was interrupted");
        sleep(Duration::from_millis(1));
    }
    send(&child, 2);
    let run = Run::from(child.wait_with_output().unwrap()).exits(4);
    run.complains(&["interrupted", "d.paving.part", "--resume"]);
    assert_eq!(folder.names(), ["d.paving.part", "d.toml"]);
    let resumed = [&pave[..], &["--resume"]].concat();
    folder.run(&resumed).exits(0);
    folder.run(&[&pave[..], &["-o", "whole.paving"]].concat()).exits(0);
    assert_eq!(folder.read("d.paving"), folder.read("whole.paving"));
    assert_eq!(folder.names(), ["d.paving", "d.toml", "whole.paving"]);
}

#[test]
fn a_paving_out_of_time_exits_3_and_is_taken_up_to_the_same_bytes() {
    let folder = Folder::new();
    folder.write("d.toml", crate::paving::DESIGN);
    let pave = ["pave", "d.toml", "--volume-gap", "0.01", "--threads", "1"];
    let out_of_time = |milliseconds: u32, resume: bool| {
        let timeout = format!("{milliseconds}ms");
        let resume = if resume { &["--resume"][..] } else { &[] };
        folder.run(&[&pave[..], &["--timeout", &timeout], resume].concat())
    };
    out_of_time(0, false).exits(3).complains(&["the time was up: nothing was written"]);
    assert_eq!(folder.names(), ["d.toml"]);
    for k in 0.. {
        let resume = folder.names().contains(&"d.paving.part".to_owned());
        let run = out_of_time(50 << k, resume);
        if run.code == Some(0) {
            break;
        }
        run.exits(3).complains(&["the time was up"]);
    }
    folder.run(&[&pave[..], &["-o", "whole.paving"]].concat()).exits(0);
    assert_eq!(folder.read("d.paving"), folder.read("whole.paving"));
    assert_eq!(folder.names(), ["d.paving", "d.toml", "whole.paving"]);
}

#[test]
fn a_paving_that_another_run_is_writing_is_left_alone() {
    const SIGSTOP: u32 = 19;
    const SIGCONT: u32 = 18;
    let folder = Folder::new();
    folder.write("d.toml", crate::paving::DESIGN);
    let pave = ["pave", "d.toml", "--volume-gap", "0.01", "--threads", "1"];
    let mut command = folder.command(&pave);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let part = folder.path("d.paving.part");
    let length = || fs::metadata(&part).map_or(0, |file| file.len());
    while length() < 10_000 {
        assert!(child.try_wait().unwrap().is_none(), "ended before it was stopped");
        sleep(Duration::from_millis(1));
    }
    send(&child, SIGSTOP);
    let before = length();
    for more in [&[][..], &["--resume"]] {
        let run = folder.run(&[&pave[..], more].concat()).exits(4);
        run.complains(&["d.paving.part", "another run is writing it"]);
    }
    assert_eq!(length(), before);
    assert_eq!(folder.names(), ["d.paving.part", "d.toml"]);
    send(&child, SIGCONT);
    Run::from(child.wait_with_output().unwrap()).exits(0);
    folder.run(&["check", "d.paving"]).exits(0).says(&["ACCEPTED"]);
    assert_eq!(folder.names(), ["d.paving", "d.toml"]);
}

/// Stops a run of `pave` once it has written something, and lets it go on after `meddle`.
fn meddled(folder: &Folder, meddle: impl FnOnce()) -> Run {
    const SIGSTOP: u32 = 19;
    const SIGCONT: u32 = 18;
    let pave = ["pave", "d.toml", "--precision", "0.012", "--threads", "1"];
    let mut command = folder.command(&pave);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let part = folder.path("d.paving.part");
    while fs::metadata(&part).map_or(0, |file| file.len()) < 10_000 {
        assert!(child.try_wait().unwrap().is_none(), "ended before it was stopped");
        sleep(Duration::from_millis(1));
    }
    send(&child, SIGSTOP);
    meddle();
    send(&child, SIGCONT);
    Run::from(child.wait_with_output().unwrap())
}

#[test]
fn nothing_is_said_of_what_another_program_wrote_into_a_paving() {
    let forged = |bytes: &[u8]| {
        // An undecided box becomes an inner one: the certified volume grows.
        let start = bytes.iter().position(|byte| *byte == b'\n').unwrap() + 1;
        let mut rest = &bytes[start..];
        loop {
            let (item, halves) = Item::read(&mut rest, 0).unwrap();
            let (Kind::Split(axis), Some(mut halves)) = (item.kind, halves) else { continue };
            if let Some(half) = halves.iter_mut().find(|half| **half == Kind::Boundary) {
                *half = Kind::Inner;
                let (end, mut pair) = (bytes.len() - rest.len(), Vec::new());
                write_pair(&mut pair, axis, [&halves[0], &halves[1]]).unwrap();
                return [&bytes[..end - 1], &pair, &bytes[end..]].concat();
            }
        }
    };
    type Forge<'a> = &'a dyn Fn(&[u8]) -> Vec<u8>;
    // Longer than the paving becomes: what the run still writes does not reach the end.
    let longer = |bytes: &[u8]| [bytes, &[4; 1 << 20]].concat();
    let other_header = |bytes: &[u8]| {
        let end = bytes.iter().position(|byte| *byte == b'\n').unwrap();
        let text = String::from_utf8_lossy(&bytes[..end]);
        let other = text.replace("\"precision\":36", "\"precision\":40");
        [other.as_bytes(), &bytes[end..]].concat()
    };
    for forge in [&forged as Forge<'_>, &longer, &other_header] {
        let folder = Folder::new();
        folder.write("d.toml", crate::paving::DESIGN);
        folder.write("d.paving", "earlier");
        let part = folder.path("d.paving.part");
        let run = meddled(&folder, || {
            let before = fs::read(&part).unwrap();
            let bytes = forge(&before);
            assert!(bytes != before);
            File::options().write(true).open(&part).unwrap().write_all(&bytes).unwrap();
        });
        run.exits(4).complains(&["was changed by another program", "nothing is said of it"]);
        assert_eq!(folder.read("d.paving"), b"earlier");
    }
}

#[test]
fn nothing_is_said_of_a_file_in_the_place_of_a_paving() {
    let folder = Folder::new();
    folder.write("d.toml", crate::paving::DESIGN);
    folder.run(&["pave", "d.toml", "--precision", "0.2", "-o", "other"]).exits(0);
    let part = folder.path("d.paving.part");
    let run = meddled(&folder, || fs::rename(folder.path("other"), &part).unwrap());
    run.exits(4).complains(&["was changed by another program"]);
}

#[test]
fn a_command_that_waits_for_its_input_can_be_interrupted() {
    let folder = Folder::new();
    for arguments in [["check", "/dev/stdin"], ["show", "/dev/stdin"], ["verify", "/dev/stdin"]] {
        let mut command = folder.command(&arguments);
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let _open = child.stdin.take();
        wait_until_caught(&mut child, 2);
        send(&child, 2);
        Run::from(child.wait_with_output().unwrap()).exits(4).complains(&["interrupted"]);
    }
}

/// Every command with an answer, and the files it needs.
const ANSWERS: [&[&str]; 9] = [
    &["verify"],
    &["verify", "--format", "json"],
    &["check", "c.json"],
    &["show", "c.json"],
    &["design", "--psi-max", "2", "--cube", "200"],
    &["init"],
    &["postulate", "--all"],
    &["completions", "bash"],
    &["--help"],
];

#[test]
fn a_closed_pipe_exits_4_without_a_panic() {
    let folder = Folder::new();
    folder.run(&["verify", "-o", "c.json"]).exits(0);
    for arguments in ANSWERS {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = folder.command(arguments).stdout(writer).output().unwrap();
        Run::from(output).exits(4);
    }
}

#[test]
fn a_full_output_exits_4_and_the_certificate_is_whole() {
    let folder = Folder::new();
    folder.run(&["verify", "-o", "c.json"]).exits(0);
    for arguments in ANSWERS {
        let full = File::options().write(true).open("/dev/full").unwrap();
        Run::from(folder.command(arguments).stdout(full).output().unwrap()).exits(4);
    }
    folder.run(&["check", "orthoglide-prototype.cert.json"]).exits(0);
}

#[test]
fn a_closed_standard_error_changes_no_exit_code() {
    let folder = Folder::new();
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let output = folder.command(&["verify", "missing.toml"]).stderr(writer).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
}
