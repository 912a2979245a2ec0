//! `postulate`.

use crate::support::Folder;

#[test]
fn it_is_proved_for_one_psi_max_a_range_and_all() {
    let folder = Folder::new();
    for (arguments, subject) in [
        (&["--psi", "2"][..], "for psi_max = 2"),
        (&["--psi", "sqrt(2)"], "for psi_max = sqrt(2)"),
        (&["--psi-range", "3/2..3"], "for 1.5 <= psi_max <= 3"),
        (&["--all"], "for every psi_max > 1"),
    ] {
        let arguments = [&["postulate", "-o", "p.json"], arguments].concat();
        folder.run(&arguments).exits(0).says(&["CERTIFIED", subject, "p.json", "sha256"]);
        folder.run(&["check", "p.json"]).exits(0).says(&["ACCEPTED: certified"]);
        folder.run(&["show", "p.json"]).exits(0).says(&["NOT CHECKED", "leaves"]);
    }
}

#[test]
fn without_an_output_nothing_is_written() {
    let folder = Folder::new();
    folder.run(&["postulate", "--all"]).exits(0).says(&["not written; -o CERT.json writes it"]);
    assert!(folder.names().is_empty());
}

#[test]
fn a_small_budget_leaves_it_undecided() {
    let folder = Folder::new();
    let run = folder.run(&["postulate", "--all", "-o", "p.json", "--max-boxes", "3"]).exits(3);
    run.says(&["UNDECIDED", "--max-boxes"]);
    assert!(folder.names().is_empty());
}

#[test]
fn the_certificate_does_not_depend_on_the_number_of_threads() {
    let folder = Folder::new();
    for threads in ["1", "2", "4", "16"] {
        let name = format!("{threads}.json");
        folder.run(&["postulate", "--all", "--threads", threads, "-o", &name]).exits(0);
        assert_eq!(folder.read(&name), folder.read("1.json"), "{threads} threads");
    }
}

#[test]
fn certificates_are_exported_to_rocq() {
    let folder = Folder::new();
    for (arguments, statement) in [
        (&["--psi", "2"][..], "Definition the_psi : quantity := 2."),
        (&["--psi-range", "3/2..5/2"], "the_psi : quantity := (Between 1.5 2.5)."),
        (&["--all"], "Theorem certified :\n  forall psi, (1 < psi)%R -> postulate_for psi."),
    ] {
        folder.run(&[&["postulate", "-o", "p.json"], arguments].concat()).exits(0);
        folder.run(&["export", "rocq", "p.json"]).exits(0).says(&["Theorem certified", statement]);
    }
}

#[test]
fn a_postulate_is_no_design() {
    let folder = Folder::with(&["orthoglide-prototype.toml"]);
    folder.run(&["postulate", "--psi", "2", "-o", "p.json"]).exits(0);
    let run = folder.run(&["check", "p.json", "--design", "orthoglide-prototype.toml"]).exits(5);
    run.complains(&["another claim"]);
}

#[test]
fn what_is_no_psi_max_is_refused() {
    for arguments in [
        &[][..],
        &["--psi", "1"],
        &["--psi", "x"],
        &["--psi", "-2"],
        &["--psi-range", "2"],
        &["--psi-range", "3..2"],
        &["--psi-range", "1..2"],
        &["--psi-range", "2.."],
        &["--psi-range", "0..2"],
        &["--psi", "2", "--all"],
    ] {
        let arguments = [&["postulate"], arguments].concat();
        let run = Folder::new().run(&arguments).exits(2);
        assert_eq!(run.stdout, "");
        assert!(run.stderr.contains("--psi") && !run.stderr.contains("psi_max"), "{}", run.stderr);
    }
}
