//! `design`, `init`, `completions`, `man`, help.

use crate::support::Folder;

#[test]
fn the_prototype_has_its_published_dimensions() {
    let run = Folder::new().run(&["design", "--psi-max", "2", "--cube", "200"]).exits(0);
    assert_eq!(run.stderr, "");
    run.says(&[
        "310.582854123024   310.582854123025",
        "-73.2050807568878  -73.2050807568877",
        "126.794919243112   126.794919243113",
        "-383.787934879913  -383.787934879912",
        "256.993015636800   256.993015636801",
        "26.5650511770779   26.5650511770780  deg",
    ]);
}

#[test]
fn a_printed_design_is_certified() {
    for (psi_max, cube, offset) in
        [("2", "200", "0"), ("1.000001", "1/3", "-5"), ("sqrt(2)", "100*sqrt(3)", "12.5")]
    {
        let folder = Folder::new();
        let arguments =
            ["design", "--psi-max", psi_max, "--cube", cube, "--offset", offset, "--toml"];
        let design = folder.run(&arguments).exits(0).stdout;
        folder.write("a.toml", &design);
        folder.run(&["verify", "a.toml"]).exits(0);
        folder.run(&["check", "a.cert.json", "--design", "a.toml"]).exits(0);
    }
}

#[test]
fn the_printed_design_of_the_prototype_is_the_built_in_one() {
    let folder = Folder::new();
    let design = folder.run(&["design", "--psi-max", "2", "--cube", "200", "--toml"]).stdout;
    folder.write("a.toml", &design);
    folder.run(&["verify"]).exits(0);
    folder.run(&["check", "orthoglide-prototype.cert.json", "--design", "a.toml"]).exits(0);
}

#[test]
fn what_is_no_machine_is_refused_with_a_sentence() {
    for (psi_max, cube, part) in [
        ("1", "200", "greater than 1"),
        ("0.5", "200", "greater than 1"),
        ("-2", "200", "greater than 1"),
        ("2", "0", "greater than 0"),
        ("2", "-200", "greater than 0"),
        ("two", "200", "not a number"),
        ("2", "nan", "not a number"),
        ("2", "inf", "not a number"),
        ("2", "1/0", "division"),
        ("", "200", "not a number"),
        ("1e1001", "200", "exponent"),
    ] {
        let run = Folder::new().run(&["design", "--psi-max", psi_max, "--cube", cube]).exits(2);
        run.complains(&[part]);
    }
    Folder::new().run(&["design", "--psi-max", "2"]).exits(2).complains(&["--cube"]);
}

#[test]
fn templates_are_designs_that_verify_reads() {
    let folder = Folder::new();
    for kind in ["orthoglide", "orthoglide-cube", "translational"] {
        let name = format!("{kind}.toml");
        folder.write(&name, folder.run(&["init", "--kind", kind]).exits(0).stdout);
        folder.run(&["verify", &name]).exits(0);
    }
    let default = folder.run(&["init"]).exits(0).stdout;
    assert_eq!(default.as_bytes(), folder.read("orthoglide.toml"));
    folder.run(&["init", "--kind", "octopod"]).exits(2).complains(&["octopod", "orthoglide"]);
    let [spatial, hexapod] =
        ["spatial", "hexapod"].map(|kind| folder.run(&["init", "--kind", kind]).exits(0).stdout);
    assert_eq!(spatial, hexapod);
}

#[test]
fn completions_exist_for_every_shell() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let run = Folder::new().run(&["completions", shell]).exits(0);
        run.says(&["orthocert", "verify", "max-boxes"]);
    }
    Folder::new().run(&["completions", "sh"]).exits(2);
}

#[test]
fn every_command_has_a_manual_page_with_all_its_flags() {
    let folder = Folder::new();
    folder.run(&["man", "pages"]).exits(0);
    let page = |name: &str| String::from_utf8(folder.read(&format!("pages/{name}.1"))).unwrap();
    let all = help(&folder, &[]);
    let lines = all.lines().skip_while(|line| *line != "Commands:").skip(1);
    let lines =
        lines.take_while(|line| !line.is_empty()).filter_map(|line| line.strip_prefix("  "));
    let commands: Vec<&str> = lines.filter_map(|line| line.split(' ').next()).collect();
    assert!(commands.len() > 20);
    for command in commands.into_iter().filter(|name| !["", "help"].contains(name)) {
        let text = page(&format!("orthocert-{command}"));
        assert!(page("orthocert").contains(&format!("orthocert\\-{}(1)", roff(command))));
        for word in help(&folder, &[command]).split_whitespace() {
            let word =
                word.trim_matches(|letter: char| !letter.is_ascii_alphanumeric() && letter != '-');
            assert!(!word.starts_with("--") || text.contains(&roff(word)), "{command} {word}");
        }
        assert!(text.contains("undecided within the budget"), "{command}");
    }
    assert!(page("orthocert-export-vtk").contains("Quadrilaterals"));
    assert!(page("orthocert-check").contains("orthocert\\-check CERT.json | PAVING"));
}

fn help(folder: &Folder, command: &[&str]) -> String {
    folder.run(&[command, &["--help"]].concat()).exits(0).stdout
}

/// As manual pages spell it.
fn roff(text: &str) -> String {
    text.replace('-', "\\-")
}

#[test]
fn help_names_the_commands_and_the_exit_codes() {
    let run = Folder::new().run(&["--help"]).exits(0);
    let run = run.says(&["verify", "check", "show", "design", "init", "postulate", "completions"]);
    run.says(&["3  undecided", "5  certificate rejected"]);
    Folder::new().run(&["--version"]).exits(0).says(&["orthocert 0."]);
    for command in ["verify", "check", "show", "design", "init", "postulate", "completions"] {
        Folder::new().run(&[command, "--help"]).exits(0).says(&["Usage: orthocert"]);
    }
}
