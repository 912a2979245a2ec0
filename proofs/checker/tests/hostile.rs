//! Files made to exhaust the checker or to mislead whoever reads its output.

use orthocert_checker::certificate::MOST_BYTES;
use orthocert_checker::{check, read, Rejected};
use orthocert_kernel::certificate::MOST_NODES;
use orthocert_kernel::document::Unreadable::{Format, Malformed, NotCanonical, TooLong};

const PROTOTYPE: &str = include_str!("../../certificates/orthoglide-prototype.cert.json");

/// The prototype's certificate with this JSON text as its nodes.
fn prototype(nodes: &str) -> String {
    let (before, rest) = PROTOTYPE.split_once("\"nodes\":[").expect("nodes");
    let (_, after) = rest.rsplit_once("]}},\"provenance\"").expect("their end");
    format!("{before}\"nodes\":{nodes}}}}},\"provenance\"{after}")
}

fn rejection(text: &str) -> Rejected {
    match read(text.as_bytes()).and_then(|certificate| check(&certificate)) {
        Ok(_) => panic!("accepted: {text:.300}"),
        Err(reason) => reason,
    }
}

fn syntax(text: &str) -> String {
    match rejection(text) {
        Rejected::Unreadable(reason @ (Malformed(_) | NotCanonical(_))) => reason.to_string(),
        other => panic!("{other:?} for {text:.300}"),
    }
}

#[test]
fn a_message_cannot_write_to_the_terminal() {
    let text = prototype("[{}]").replace("\"proof\"", r#""\u001b[2K\rACCEPTED: \u202ecertified""#);
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
fn another_version_is_named_whatever_its_shape() {
    let text = r#"{"format":"orthocert/3","something":[1.5,null,{"else":true}]}"#;
    assert_eq!(rejection(text), Format("orthocert/3".into(), "orthocert/2").into());
    syntax(r#"{"format":"orthocert/2","something":[]}"#);
    syntax(r#"{"format":"orthocert/3","format":"orthocert/2"}"#);
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
    let padded = |size: usize| PROTOTYPE.to_owned() + &" ".repeat(size - PROTOTYPE.len());
    // Blanks are in no certificate, but what is refused is not refused for its size.
    assert!(matches!(
        read(padded(MOST_BYTES).as_bytes()),
        Err(Rejected::Unreadable(NotCanonical(_)))
    ));
    assert_eq!(read(padded(MOST_BYTES + 1).as_bytes()), Err(TooLong(MOST_BYTES).into()));
}

/// Powers of powers are undefined before they are long: what is made of them costs little.
#[test]
fn numbers_do_not_grow_without_end() {
    let sums = |x: &str, n: usize| -> String {
        let all = (0..n).map(|i| format!(r#",["e{}","e{i}+{x}"]"#, i + 1));
        format!(r#"["e0","{x}"]"#) + &all.collect::<String>()
    };
    let text = |x: &str| {
        format!(
            r#"{{"format":"orthocert/2","claim":{{"machine":{{"mechanism":{{"formulas":{{"coordinates":["x"],"parameters":[],"definitions":[["a","x^64"],["b","a^64"],["c","b^22"],{}],"joints":[{{"row":["e200"]}}]}}}},"workspace":{{"box":{{"min":["2"],"max":["2.5"]}}}},"require":[]}}}},"verdict":"certified","proof":{{"tree":{{"precision":64,"nodes":[{{"by":[[0,{{"rank":{{"y":[[1]],"places":0}}}}]]}}]}}}},"provenance":{{"tool":"hand","version":"1"}}}}
"#,
            sums(x, 200)
        )
    };
    assert!(read(text("x").as_bytes()).and_then(|c| check(&c)).is_ok());
    assert!(!matches!(rejection(&text("c")), Rejected::Unreadable(_)));
}

/// Resident memory of a check of the most wasteful files that are read at all.
#[cfg(target_os = "linux")]
#[test]
fn memory_is_bounded() {
    use std::process::Command;
    let list = |item: &str, most: usize| {
        let count = ((MOST_BYTES - 1000) / (item.len() + 1)).min(most);
        format!("[{}{item}]", format!("{item},").repeat(count - 1))
    };
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("hostile");
    std::fs::create_dir_all(&folder).unwrap();
    let steps = |step: &str, most| format!("[{{\"by\":{}}}]", list(step, most));
    let roots = format!("{}2{}", "sqrt(".repeat(60), ")".repeat(60));
    // Halves of so many numbers, the upper ones of which all wait.
    let numbers: Vec<String> =
        (0..16_000).map(|i| format!(r#"["a{i}",{{"min":"1","max":"3"}}]"#)).collect();
    let halved: Vec<String> = (0..2000).map(|i| format!(r#"{{"split":{}}},"#, i + 1)).collect();
    let halves = format!(
        r#"{{"format":"orthocert/2","claim":{{"machine":{{"mechanism":{{"formulas":{{"coordinates":["x"],"parameters":[{}],"definitions":[],"joints":[{{"rho":"x"}}]}}}},"workspace":{{"box":{{"min":["0"],"max":["1"]}}}},"require":[]}}}},"verdict":"certified","proof":{{"tree":{{"precision":40,"nodes":[{}{}]}}}},"provenance":{{"tool":"hand","version":"1"}}}}
"#,
        numbers.join(","),
        halved.concat(),
        vec!["{}"; 2001].join(",")
    );
    for (name, text) in [
        ("halves", halves),
        ("steps", prototype(&steps("[0,\"cube\"]", MOST_BYTES))),
        ("evidence", prototype(&steps(r#"[0,{"lower":{"y":[[1]],"places":0}}]"#, MOST_BYTES))),
        ("empty-nodes", prototype(&list("{}", MOST_BYTES))),
        ("nodes", prototype(&list(r#"{"by":[[0,"cube"]]}"#, MOST_BYTES))),
        ("few-nodes", prototype(&list(r#"{"by":[[0,"cube"]]}"#, MOST_NODES))),
        ("key", prototype("[{}]").replace("proof", &"é".repeat(MOST_BYTES / 2 - 1000))),
        ("number", prototype("[{}]").replace("\"200\"", &format!("\"{roots}\""))),
    ] {
        assert!(text.len() <= MOST_BYTES, "{name}");
        let path = folder.join(name);
        std::fs::write(&path, text).unwrap();
        // The shell's limit on the address space makes an allocation beyond it abort.
        let status = Command::new("sh")
            .args(["-c", "ulimit -v 400000 && exec \"$0\" \"$1\""])
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
        assert!(said.trim_end().chars().all(|c| matches!(c, ' '..='~')), "{said:?}");
        assert!(!said.contains("##[") && output.stdout.is_empty(), "{said:?}");
    }
    std::fs::remove_dir_all(&folder).unwrap();
}
