//! Certificates appear whole or not at all.

use crate::support::Folder;
use std::fs;

#[test]
fn a_certificate_replaces_the_one_that_was_there() {
    let folder = Folder::new();
    folder.write("a.json", "x".repeat(100_000));
    folder.run(&["verify", "-o", "a.json"]).exits(0);
    folder.run(&["check", "a.json"]).exits(0);
    assert_eq!(folder.names(), ["a.json"]);
}

#[test]
fn outputs_that_cannot_be_written_exit_4() {
    let folder = Folder::with(&["orthoglide-310.toml"]);
    fs::create_dir(folder.path("sub")).unwrap();
    folder.write("file", "kept");
    for (output, part) in [
        ("missing/a.json", "there is no folder missing"),
        ("sub", "it is a folder"),
        ("file/a.json", "there is no folder file"),
        ("..", "it is a folder"),
    ] {
        let run = folder.run(&["verify", "-o", output]).exits(4);
        run.complains(&[output, "cannot be written", part]);
        let run = folder.run(&["postulate", "--all", "-o", output]).exits(4);
        run.complains(&[output, "cannot be written"]);
    }
    assert_eq!(folder.names(), ["file", "orthoglide-310.toml", "sub"]);
    assert_eq!(folder.read("file"), b"kept");
}

#[test]
fn a_read_only_file_is_kept() {
    let folder = Folder::new();
    folder.write("a.json", "kept");
    let mut permissions = fs::metadata(folder.path("a.json")).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(folder.path("a.json"), permissions).unwrap();
    folder.run(&["verify", "-o", "a.json"]).exits(4).complains(&["read-only"]);
    assert_eq!(folder.read("a.json"), b"kept");
}

#[test]
fn a_design_is_never_overwritten_by_its_certificate() {
    let folder = Folder::with(&["orthoglide-312.toml"]);
    let before = folder.read("orthoglide-312.toml");
    for output in ["orthoglide-312.toml", "./orthoglide-312.toml"] {
        let run = folder.run(&["verify", "orthoglide-312.toml", "-o", output]).exits(2);
        run.complains(&["is a file that is read"]);
    }
    assert_eq!(folder.read("orthoglide-312.toml"), before);
}

#[test]
fn an_undecided_run_leaves_an_earlier_certificate_and_says_so() {
    let folder = Folder::with(&["orthoglide-312.toml", "orthoglide-310.toml"]);
    let (undecided, output) = (["--max-boxes", "1", "--reprove"], ["-o", "a.json"]);
    folder.run(&["verify", "orthoglide-312.toml", output[0], output[1]]).exits(0);
    let before = folder.read("a.json");
    let arguments = [&["verify", "orthoglide-312.toml"][..], &output, &undecided].concat();
    folder.run(&arguments).exits(3).says(&["earlier file", "it is about this very claim"]);
    let changed = String::from_utf8(folder.read("orthoglide-312.toml")).unwrap();
    folder.write("changed.toml", changed.replace("= 312", "= 312.5"));
    let arguments = [&["verify", "changed.toml"][..], &output, &undecided].concat();
    folder.run(&arguments).exits(3).says(&["earlier file", "it is NOT about this claim"]);
    assert_eq!(folder.read("a.json"), before);
    folder.run(&["check", "a.json", "--design", "changed.toml"]).exits(5);
}

#[cfg(unix)]
#[test]
fn a_certificate_has_the_permissions_of_any_new_file() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    folder.write("plain", "");
    folder.run(&["verify", "-o", "a.json"]).exits(0);
    let mode = |name: &str| fs::metadata(folder.path(name)).unwrap().permissions().mode();
    assert_eq!(mode("a.json"), mode("plain"));
}

#[cfg(unix)]
#[test]
fn a_link_is_refused_or_followed() {
    let folder = Folder::new();
    fs::create_dir(folder.path("real")).unwrap();
    folder.write("real/a.json", "old");
    std::os::unix::fs::symlink("real/a.json", folder.path("link.json")).unwrap();
    let refused = folder.run(&["verify", "-o", "link.json"]).exits(4);
    refused.complains(&["link.json", "a symbolic link", "--follow-links"]);
    assert!(folder.read("real/a.json") == b"old");
    folder.run(&["verify", "-o", "link.json", "--follow-links"]).exits(0);
    assert!(fs::symlink_metadata(folder.path("link.json")).unwrap().is_symlink());
    folder.run(&["check", "real/a.json"]).exits(0);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_exits_4_and_a_device_stays_a_device() {
    let folder = Folder::new();
    let run = folder.run(&["verify", "-o", "/dev/full"]).exits(4);
    run.complains(&["/dev/full", "cannot be written", "No space left"]);
    folder.run(&["verify", "-o", "/dev/null"]).exits(0);
    assert!(!fs::metadata("/dev/null").unwrap().is_file());
    assert!(folder.names().is_empty());
}

/// What took minutes to find is told, though no file holds its certificates.
#[cfg(target_os = "linux")]
#[test]
fn an_answer_is_told_though_the_disk_is_full() {
    let file = "tripteron.toml";
    for (command, said) in [
        (&["bounds", file][..], "psi"),
        (&["tolerance", file], "direction"),
        (&["limit", file, "requirements.transmission.max"], "certified"),
        (&["size", "--cube", "200", "--gap", "0.1"], "smallest leg length"),
        (&["largest-cube", "orthoglide-312.toml", "--gap", "0.1"], "largest cube: side between"),
    ] {
        let folder = Folder::with(&[file, "orthoglide-312.toml"]);
        let run = folder.run_on_a_full_disk(&[command, &["-o", "."]].concat()).exits(4);
        assert!(!run.says(&[said]).stdout.contains(".cert.json"), "{command:?}");
        assert_eq!(folder.names(), ["orthoglide-312.toml", file], "{command:?}");
    }
}

#[test]
fn what_is_read_is_not_overwritten() {
    let folder = Folder::with(&["orthoglide-312.toml"]);
    folder.run(&["verify", "orthoglide-312.toml", "-o", "c.json"]).exits(0);
    folder.run(&["pave", "orthoglide-312.toml", "--precision", "90", "-o", "p"]).exits(0);
    folder.write("k.cfg", "[printer]\nkinematics: delta\n");
    for command in [
        &["import", "klipper", "k.cfg", "-o", "./k.cfg"][..],
        &["import", "linuxcnc", "other.ini", "k.cfg", "-o", "k.cfg"],
        &["export", "rocq", "c.json", "-o", "c.json"],
        &["export", "stl", "p", "-o", "p"],
        &["export", "vtk", "./p", "-o", "p"],
    ] {
        let read = command.last().unwrap();
        let before = folder.read(read);
        folder.run(command).exits(2).complains(&["--output", "is read", "another path"]);
        assert!(folder.read(read) == before, "{command:?}");
    }
}

#[test]
fn a_design_in_a_folder_of_certificates_is_not_overwritten() {
    let folder = Folder::with(&["orthoglide-312.toml"]);
    let design = folder.read("orthoglide-312.toml");
    for (command, name) in [
        (&["size", "--cube", "200"][..], "size-certified.cert.json"),
        (&["tolerance"], "nominal.cert.json"),
        (&["bounds"], "psi-least-outer.cert.json"),
    ] {
        folder.write(name, &design);
        let run = folder.run(&[command, &[name, "-o", "."]].concat()).exits(2);
        run.complains(&["--output", name, "is a file that is read"]);
        assert!(folder.read(name) == design, "{name}");
    }
}
