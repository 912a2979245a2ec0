//! Every class of bad usage and bad input: exit 2, one message, nothing written.

use crate::support::Folder;

/// A good design, to be spoiled.
const DESIGN: &str = "\
[mechanism]
kind = \"orthoglide\"
leg_length = 312

[workspace]
min = [-73, -73, -73]
max = [126, 126, 126]

[requirements]
transmission = { min = 0.5, max = 2 }
";

fn refused(content: impl AsRef<[u8]>, parts: &[&str]) {
    let folder = Folder::new();
    folder.write("bad.toml", content);
    let run = folder.run(&["verify", "bad.toml"]).exits(2).complains(&["bad.toml"]);
    run.complains(parts);
    assert_eq!(folder.names(), ["bad.toml"]);
}

#[test]
fn the_unspoiled_design_is_certified() {
    let folder = Folder::new();
    folder.write("good.toml", DESIGN);
    folder.run(&["verify", "good.toml"]).exits(0);
}

#[test]
fn spoiled_designs_are_refused_with_line_key_and_what_is_accepted() {
    for (old, new, parts) in [
        ("kind =", "kin =", &["bad.toml:1", "mechanism.kind", "nothing: the key is missing"][..]),
        ("leg_length = 312\n", "", &["leg_length"]),
        ("312", "\"long\"", &["bad.toml:3", "mechanism.leg_length", "long", "accepted"]),
        ("312", "[312]", &["bad.toml:3", "leg_length", "accepted"]),
        ("312", "0", &["bad.toml:3", "greater than 0"]),
        ("312", "-312", &["bad.toml:3", "greater than 0"]),
        ("312", "nan", &["bad.toml:3", "finite"]),
        ("312", "1e1001", &["bad.toml:3", "leg_length"]),
        ("min = [-73", "min = [273", &["bad.toml:7", "workspace.max.0", "273"]),
        ("126, 126, 126", "126, 126", &["bad.toml:7", "max"]),
        ("min = 0.5", "min = 0", &["bad.toml:10", "transmission.min", "greater than 0"]),
        ("max = 2 ", "max = 0.5 ", &["bad.toml:10", "transmission"]),
        ("\"orthoglide\"", "\"hexapod\"", &["bad.toml:2", "hexapod", "orthoglide"]),
        ("[workspace]", "[workspace", &["bad.toml:5"]),
        ("leg_length", "kind", &["bad.toml:3", "kind"]),
    ] {
        assert!(DESIGN.contains(old));
        refused(DESIGN.replacen(old, new, 1), parts);
    }
    refused(DESIGN.replace("312", &"1".repeat(1001)), &["bad.toml:3", "1,000"]);
    refused(DESIGN.replace("312", &format!("\"{}1{}\"", "(".repeat(5000), ")".repeat(5000))), &[]);
    refused(DESIGN.replace("312", &format!("{}1{}", "[".repeat(50_000), "]".repeat(50_000))), &[]);
}

#[test]
fn what_is_no_text_is_refused() {
    refused(b"title = \"\xff\"", &["UTF-8"]);
    refused(b"\x00\x01\x02", &[]);
    refused("", &["mechanism"]);
    refused(vec![b'#'; (1 << 20) + 1], &["more than"]);
}

#[test]
fn paths_that_are_no_files_are_refused() {
    let folder = Folder::new();
    folder.run(&["verify", "."]).exits(2).complains(&["without designs"]);
    folder.run(&["verify", "missing.toml"]).exits(2).complains(&["missing.toml", "cannot be read"]);
    folder.run(&["verify", ""]).exits(2);
    folder.write("file", "");
    folder.run(&["verify", "file/a.toml"]).exits(2);
    assert_eq!(folder.names(), ["file"]);
}

#[cfg(unix)]
#[test]
fn an_unreadable_file_is_refused() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    folder.write("secret.toml", DESIGN);
    let secret = folder.path("secret.toml");
    std::fs::set_permissions(&secret, std::fs::Permissions::from_mode(0o000)).unwrap();
    // The superuser reads everything.
    if std::fs::read(&secret).is_err() {
        folder.run(&["verify", "secret.toml"]).exits(2).complains(&["cannot be read"]);
    }
}

#[test]
fn bad_usage_exits_2() {
    for arguments in [
        &[][..],
        &["prove"],
        &["verify", "--fast"],
        &["verify", "--jobs", "0", "a.toml"],
        &["verify", "--max-boxes", "0"],
        &["verify", "--max-boxes", "-1"],
        &["verify", "--max-boxes", "many"],
        &["verify", "--threads", "0"],
        &["verify", "--threads", "1000000"],
        &["verify", "--timeout", "-1"],
        &["verify", "--timeout", "soon"],
        &["verify", "--timeout", "nan"],
        &["verify", "--format", "xml"],
        &["verify", "-o"],
        &["check"],
        &["design"],
    ] {
        let folder = Folder::new();
        let run = folder.run(arguments).exits(2);
        assert_eq!(run.stdout, "", "{arguments:?}");
        assert_ne!(run.stderr, "", "{arguments:?}");
        assert!(folder.names().is_empty());
    }
}

#[cfg(target_os = "linux")]
#[test]
fn arguments_that_are_no_text_are_paths_or_refused() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let folder = Folder::new();
    let odd = OsStr::from_bytes(b"odd\xff.toml");
    std::fs::write(folder.path("").join(odd), DESIGN).unwrap();
    let output = folder.command(&["verify"]).arg(odd).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert!(folder.path("").join(OsStr::from_bytes(b"odd\xff.cert.json")).is_file());
    let output = folder.command(&["verify", "--timeout"]).arg(odd).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn whole_numbers_are_refused_in_the_words_of_other_values() {
    let folder = Folder::new();
    for (arguments, accepted) in [
        (&["verify", "a.toml", "--max-boxes"][..], "from 1 to 18446744073709551615"),
        (&["verify", "a.toml", "--threads"], "from 1 to 1024"),
        (&["verify", "a.toml", "--jobs"], "from 1 to 1024"),
        (&["check", "a", "--jobs"], "from 1 to 1024"),
        (&["check", "a", "--sample"], "from 1 to 1000000"),
        (&["check", "a", "--sample", "9", "--seed"], "from 0 to 18446744073709551615"),
        (&["pave", "a.toml", "--max-boxes"], "from 1 to 18446744073709551615"),
        (&["pave", "a.toml", "--memory"], "from 0 to 18446744073709551615"),
        (&["pave", "a.toml", "--threads"], "from 1 to 1024"),
        (&["split", "a.toml", "--out", "b", "--shards"], "from 1 to"),
        (&["split", "a.toml", "--out", "b", "--shards", "9", "--max-boxes"], "from 1 to 500000"),
        (&["run-shard", "a", "--threads"], "from 1 to 1024"),
    ] {
        let option = arguments.last().unwrap();
        for value in ["-1", "1.5", "many", "", "99999999999999999999"] {
            let found = format!("orthocert: {option}: found \"{value}\"; accepted: a whole number");
            let arguments: Vec<&str> = arguments.iter().copied().chain([value]).collect();
            folder.run(&arguments).exits(2).complains(&[&found, accepted]);
        }
    }
    assert!(folder.names().is_empty());
}

#[test]
fn flags_take_no_tolerances_and_nothing_that_may_be_one() {
    let folder = Folder::new();
    folder.write("good.toml", DESIGN);
    for value in ["2 ± 0.1", "2 +/- 0.1", "2 +0.1", "2 +0.1 -0.1", "2+0.1/-0.1", "2 +- 0.1"] {
        for flags in [
            &["postulate", "--psi"][..],
            &["design", "--cube", "200", "--psi-max"],
            &["design", "--psi-max", "2", "--cube"],
            &["largest-cube", "good.toml", "--side"],
            &["bounds", "good.toml", "--relative"],
            &["size", "good.toml", "--cube"],
        ] {
            let flags: Vec<&str> = flags.iter().copied().chain([value]).collect();
            folder.run(&flags).exits(2).complains(&["may be read as a tolerance"]);
        }
    }
    assert_eq!(folder.names(), ["good.toml"]);
}
