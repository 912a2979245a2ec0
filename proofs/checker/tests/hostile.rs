//! Files made to exhaust the checker or to mislead whoever reads its output.

use orthocert_checker::certificate::{MAX_BYTES, MAX_NODES};
use orthocert_checker::number::{Exact, NumberErrorKind, MAX_ROOTS};
use orthocert_checker::{check, read, Rejected};

/// The prototype's claim with this JSON text as its nodes.
fn prototype(nodes: &str) -> String {
    format!(
        r#"{{"format":"orthocert/2",
"claim":{{"machine":{{"mechanism":{{"orthoglide":{{"offset":"0"}}}},
"workspace":{{"cube":{{"side":"200"}}}},"requirements":{{"transmission":{{"max":"2"}}}}}}}},
"verdict":"certified","proof":{{"tree":{{"precision":64,"nodes":{nodes}}}}},
"provenance":{{"tool":"hand","version":"1"}}}}"#
    )
}

fn rejection(text: &str) -> Rejected {
    match read(text.as_bytes()).and_then(|certificate| check(&certificate)) {
        Ok(_) => panic!("accepted: {text:.300}"),
        Err(reason) => reason,
    }
}

fn syntax(text: &str) -> String {
    match rejection(text) {
        Rejected::Syntax(message) => message,
        other => panic!("{other:?} for {text:.300}"),
    }
}

#[test]
fn a_message_cannot_write_to_the_terminal() {
    let text = prototype("[]").replace("\"proof\"", r#""\u001b[2K\rACCEPTED: \u202ecertified""#);
    let message = syntax(&text);
    assert!(message.contains("ACCEPTED"), "{message}");
    assert!(!message.chars().any(|c| c.is_control() || c == '\u{202e}'), "{message:?}");
    let text = prototype("[]").replace("orthocert/2", r"\u001b[2K");
    assert!(!rejection(&text).to_string().contains('\u{1b}'));
}

#[test]
fn messages_are_short() {
    let long = "é".repeat(1 << 20);
    for place in ["\"proof\"", "orthocert/2", "\"verdict\"", "\"certified\"", "\"200\""] {
        let text = prototype("[]").replace(place, &place.replace(|c| c != '"', &long));
        assert!(rejection(&text).to_string().len() < 1000, "{place}");
    }
}

#[test]
fn nothing_but_integers_stands_outside_strings() {
    for (from, to) in [
        // "null" is not "absent".
        (r#"{"max":"2"}"#, r#"{"min":null,"max":"2"}"#),
        (r#""requirements":{"#, r#""requirements":{"joint_range":null,"#),
        (r#""nodes":["#, r#""nodes":[{"split":null}"#),
        (r#""nodes":["#, r#""nodes":[{"by":null}"#),
        // A name is a string, not an object that holds null.
        (r#""nodes":["#, r#""nodes":[{"split":{"x":null}}"#),
        (r#""nodes":["#, r#""nodes":[{"by":[{"cube":null}]}"#),
        (r#""certified""#, r#"{"certified":null}"#),
        ("64", "64.0"),
        ("64", "6.4e1"),
        ("64", "64e0"),
        ("64", "+64"),
        ("64", "NaN"),
        ("64", "Infinity"),
        ("64", "true"),
    ] {
        let text = prototype("[]");
        assert!(text.contains(from));
        let message = syntax(&text.replacen(from, to, 1));
        assert!(message.contains("outside a string"), "{to}: {message}");
    }
}

#[test]
fn a_name_is_a_string() {
    let leg = |i: usize, mode: &str| {
        let mut direction = ["0"; 3];
        direction[i] = "1";
        format!(
            r#"{{"drive":"slider","direction":{direction:?},"anchor":["0","0","0"],
            "platform":["0","0","0"],"length":"9","mode":{mode}}}"#
        )
    };
    let text = |mode: &str| {
        let mechanism =
            format!(r#"{{"translational":[{},{},{}]}}"#, leg(0, mode), leg(1, mode), leg(2, mode));
        prototype(r#"[{"by":[{"lower":{"q":[1,0,0,0],"sign":"+"}}]}]"#)
            .replace(r#"{"orthoglide":{"offset":"0"}}"#, &mechanism)
            .replace(
                r#"{"cube":{"side":"200"}}"#,
                r#"{"box":{"min":["-1","-1","-1"],"max":["1","1","1"]}}"#,
            )
    };
    assert!(read(text(r#""+""#).as_bytes()).and_then(|c| check(&c)).is_ok());
    for mode in [r#"{"+":{}}"#, r#"{"+":[]}"#, "[]", "0", r#"["+"]"#] {
        syntax(&text(mode));
    }
}

#[test]
fn another_version_is_named_whatever_its_shape() {
    let text = r#"{"format":"orthocert/3","something":[1.5,null,{"else":true}]}"#;
    assert_eq!(rejection(text), Rejected::Format("orthocert/3".into()));
    syntax(r#"{"format":"orthocert/2","something":[]}"#);
    syntax(r#"{"format":"orthocert/3","format":"orthocert/2"}"#);
}

#[test]
fn a_step_for_what_is_already_discharged_is_refused() {
    let failure = |nodes: &str| rejection(&prototype(nodes)).to_string();
    let twice = failure(r#"[{"by":["cube","cube"]}]"#);
    assert!(twice.starts_with("node 0") && twice.contains("already"), "{twice}");
    let below = failure(r#"[{"by":["cube"],"split":"x"},{"by":["cube"]},{}]"#);
    assert!(below.starts_with("node 1") && below.contains("already"), "{below}");
}

#[test]
fn deep_nesting_does_not_exhaust_the_stack() {
    for (open, close) in [("[", "]"), ("{\"by\":[", "]}"), ("{\"a\":", "}")] {
        let depth = 1_000_000;
        syntax(&prototype(&(open.repeat(depth) + &close.repeat(depth))));
        syntax(&open.repeat(depth));
    }
}

#[test]
fn the_size_limit_is_exact() {
    let text = prototype("[]");
    let padded = |size: usize| text.clone() + &" ".repeat(size - text.len());
    assert!(read(padded(MAX_BYTES).as_bytes()).is_ok());
    assert_eq!(read(padded(MAX_BYTES + 1).as_bytes()), Err(Rejected::TooLarge(MAX_BYTES + 1)));
}

/// The work that a number asks for is bounded by the limits on its text: what goes beyond them is
/// refused before it is worked on.
#[test]
fn numbers_that_ask_for_much_work_are_refused() {
    let roots = |n: usize| format!("{}2{}", "sqrt(".repeat(n), ")".repeat(n));
    let kind = |text: &str| Exact::parse(text, 1000).map_err(|error| error.kind);
    assert!(kind(&roots(MAX_ROOTS)).is_ok());
    assert_eq!(kind(&roots(MAX_ROOTS + 1)), Err(NumberErrorKind::TooManyRoots));
    let many = vec![roots(4); 5].join("+");
    assert_eq!(kind(&many), Err(NumberErrorKind::TooManyRoots));
    // Fractions of a long denominator: every sum is as long as it.
    let sum = |n: usize| format!("1e-1000*1e-1000{}", "+1/3".repeat(n));
    assert!(kind(&sum(1)).is_ok());
    assert_eq!(kind(&sum(3)), Err(NumberErrorKind::TooLarge));
    assert!(kind(&format!("{}e-1000", "7".repeat(1000))).is_ok());
    // What no precision tried tells from zero has no sign.
    let small = |n: u32| format!("sqrt(2)*1e-1000*1e-1000*1e-{n}");
    assert_eq!(kind(&small(400)).map(|x| x.sign()), Ok(Some(1)));
    assert_eq!(kind(&small(500)).map(|x| x.sign()), Ok(None));
}

#[test]
fn signs_of_signs_are_no_tree() {
    for (written, text) in
        [("--sqrt(2)", "sqrt(2)"), ("-(-(-sqrt(2)))", "-sqrt(2)"), ("1--sqrt(2)", "1--sqrt(2)")]
    {
        assert_eq!(Exact::parse(written, 1000).map(|x| x.to_string()), Ok(text.to_owned()));
    }
    let text = prototype("[]").replace("\"200\"", "\"--sqrt(2)\"");
    assert!(syntax(&text).contains("canonical form"));
}

/// A file has irrational numbers in its claim and in one machine alone, however long it is.
#[test]
fn points_are_rational() {
    let good = include_str!("certificates/orthoglide-310.cert.json");
    let (before, rest) = good.split_once("\"point\":[\"").expect("a point");
    let (_, after) = rest.split_once('"').expect("a number");
    let irrational = format!("{before}\"point\":[\"sqrt(2)\"{after}");
    assert!(syntax(&irrational).contains("a point is not three rational numbers"));
}

/// Resident memory of a check of the most wasteful files that are read at all.
#[cfg(target_os = "linux")]
#[test]
fn memory_is_bounded() {
    use std::process::Command;
    let list = |item: &str, most: usize| {
        let count = ((MAX_BYTES - 1000) / (item.len() + 1)).min(most);
        format!("[{}{item}]", format!("{item},").repeat(count - 1))
    };
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("hostile");
    std::fs::create_dir_all(&folder).unwrap();
    let steps = format!("[{{\"by\":{}}}]", list("\"cube\"", MAX_BYTES));
    for (name, text) in [
        ("steps", prototype(&steps)),
        ("empty-nodes", prototype(&list("{}", MAX_NODES))),
        ("nodes", prototype(&list(r#"{"by":["cube"]}"#, MAX_NODES))),
        ("full-nodes", prototype(&list(r#"{"by":["cube","cube","cube"]}"#, MAX_NODES))),
        ("key", prototype("[]").replace("proof", &"é".repeat(MAX_BYTES / 2 - 1000))),
    ] {
        assert!(text.len() <= MAX_BYTES, "{name}");
        let path = folder.join(name);
        std::fs::write(&path, text).unwrap();
        // The shell's limit on the address space makes an allocation beyond it abort.
        let status = Command::new("sh")
            .args(["-c", "ulimit -v 200000 && exec \"$0\" \"$1\""])
            .arg(env!("CARGO_BIN_EXE_orthocert-check"))
            .arg(&path)
            .stderr(std::process::Stdio::null())
            .status()
            .unwrap();
        assert_eq!(status.code(), Some(5), "{name}: {status}");
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

#[cfg(unix)]
#[test]
fn what_is_no_file_is_not_waited_for_and_names_stay_on_their_line() {
    use std::process::{Command, Stdio};
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("no-files");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let name = |name: &str| folder.join(format!("::error::\n\u{1b}[2J\u{202e}##[x]{name}"));
    assert!(Command::new("mkfifo").arg(name("pipe")).status().unwrap().success());
    std::os::unix::fs::symlink("/dev/zero", name("device")).unwrap();
    std::fs::File::create(name("endless")).unwrap().set_len(1 << 40).unwrap();
    for (file, code) in [("pipe", 2), ("device", 2), ("absent", 2), ("endless", 5)] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_orthocert-check"));
        let piped = command.arg(name(file)).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = piped.spawn().unwrap();
        let started = std::time::Instant::now();
        while child.try_wait().unwrap().is_none() {
            if started.elapsed().as_secs() > 60 {
                child.kill().unwrap();
                panic!("{file} is waited for");
            }
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{file}");
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(said.lines().count(), 1, "{said:?}");
        assert!(!said.trim_end().chars().any(orthocert_checker::shown::is_unseen), "{said:?}");
        assert!(!said.contains("##[") && output.stdout.is_empty(), "{said:?}");
    }
    std::fs::remove_dir_all(&folder).unwrap();
}
