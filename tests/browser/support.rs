//! Reports to look at, and looking at pictures.

use orthocert::design::Design;
use orthocert::search::solver::sample::{Place, Sampler};
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::machine::Leg;
use orthocert_kernel::problem::Problem;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// A browser's program; `None`, after a word on standard error, where there is none and none is
/// demanded.
pub fn on_path(browser: &str, names: &[&str]) -> Option<PathBuf> {
    let folders = std::env::var_os("PATH").unwrap_or_default();
    let found = std::env::split_paths(&folders)
        .flat_map(|folder| names.iter().map(move |name| folder.join(name)))
        .find(|path| path.is_file());
    if found.is_none() {
        let demanded = std::env::var("ORTHOCERT_BROWSER").is_ok_and(|value| value == "required");
        assert!(!demanded, "ORTHOCERT_BROWSER=required, and there is no {browser} on the PATH");
        eprintln!("skipped: no {browser} on the PATH");
    }
    found
}

/// What a page says of its claim, once it has proved it again, or not.
pub const PROVED: &str =
    "new Promise((done) => { const look = () => { const s = \
     document.getElementById('reproved').dataset.state; s ? done(s) : setTimeout(look, 10); }; look(); })";

/// Waits for a browser that was asked to end, and ends it if it does not.
pub fn ended(child: &mut Child) {
    let until = Instant::now() + Duration::from_secs(5);
    while Instant::now() < until {
        if matches!(child.try_wait(), Ok(Some(_))) {
            return;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    let _ = child.kill();
    let _ = child.wait();
}

/// A folder for certificates and reports.
pub struct Folder(TempDir);

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

impl Folder {
    pub fn new() -> Self {
        Folder(tempfile::tempdir().unwrap())
    }

    fn run(&self, arguments: &[&str]) -> Option<i32> {
        let mut command = Command::new(env!("CARGO_BIN_EXE_orthocert"));
        command.current_dir(self.0.path()).args(arguments).stdin(Stdio::null());
        command.stdout(Stdio::null()).status().unwrap().code()
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        self.0.path()
    }

    /// What a command says on standard error, and its exit code.
    pub fn said(&self, arguments: &[&str]) -> (String, Option<i32>) {
        let mut command = Command::new(env!("CARGO_BIN_EXE_orthocert"));
        command.current_dir(self.0.path()).args(arguments).stdin(Stdio::null());
        let output = command.output().unwrap();
        (String::from_utf8(output.stderr).unwrap(), output.status.code())
    }

    /// The report of a committed certificate.
    pub fn report_of_committed(&self, name: &str, options: &[&str]) -> PathBuf {
        self.report_from("proofs/certificates", name, options)
    }

    /// The report of a certificate of the kernel.
    pub fn report_of_kernel(&self, name: &str) -> PathBuf {
        self.report_from("tests/kernel", name, &[])
    }

    fn report_from(&self, from: &str, name: &str, options: &[&str]) -> PathBuf {
        let file = format!("{name}.cert.json");
        fs::copy(root().join(from).join(&file), self.0.path().join(&file)).unwrap();
        let code = self.run(&[&["report", &file], options].concat());
        assert!(matches!(code, Some(0 | 1)), "{name}: {code:?}");
        self.0.path().join(format!("{name}.report.html"))
    }

    /// The report of a committed design, and its claim.
    pub fn report_of_design(&self, name: &str) -> (PathBuf, MachineClaim) {
        let path = root().join("tests/designs").join(format!("{name}.toml"));
        let text = fs::read_to_string(&path).unwrap();
        let (_, name) = name.rsplit_once('/').unwrap_or(("", name));
        let page = report(self, name, &text, 0).unwrap();
        let claim = Design::read(&path).unwrap().claim;
        (page, claim)
    }

    /// The report of a paving of the Orthoglide's dextrous region with boxes of this edge.
    pub fn report_of_paving(&self, edge: &str) -> PathBuf {
        let design = "[mechanism]\nkind = \"orthoglide\"\nleg_length = 1\n[workspace]\n\
                      min = [-0.7, -0.7, -0.7]\nmax = [0.7, 0.7, 0.7]\n[requirements]\n\
                      transmission = { min = \"1/2\", max = 2 }\n";
        fs::write(self.0.path().join("region.toml"), design).unwrap();
        assert_eq!(self.run(&["pave", "region.toml", "--precision", edge, "--quiet"]), Some(0));
        assert_eq!(self.run(&["report", "region.paving"]), Some(0));
        self.0.path().join("region.paving.report.html")
    }

    /// The report about a machine of the oracle in a small box about one of its points; `None` if
    /// that box is undecided.
    pub fn report_about(&self, case: &Value, point: &Value) -> Option<PathBuf> {
        let mut design = "[mechanism]\nkind = \"translational\"\n".to_owned();
        for leg in case["legs"].as_array().unwrap() {
            design.push_str("[[mechanism.legs]]\ndrive = \"slider\"\n");
            for key in ["direction", "anchor", "platform", "length", "mode"] {
                design.push_str(&format!("{key} = {}\n", leg[key]));
            }
        }
        let end = |sign: &str| -> Vec<String> {
            let ends = point["point"].as_array().unwrap().iter();
            ends.map(|x| format!("\"{} {sign} 1/1000\"", x.as_str().unwrap())).collect()
        };
        let [min, max] = [end("-"), end("+")].map(|ends| ends.join(", "));
        design.push_str(&format!("[workspace]\nmin = [{min}]\nmax = [{max}]\n"));
        design.push_str("[requirements]\ntransmission = { max = 1000 }\n");
        report(self, "oracle", &design, 0)
    }
}

/// The report of a design with this verdict; `None` if there is another.
pub fn report(folder: &Folder, name: &str, design: &str, verdict: i32) -> Option<PathBuf> {
    let [file, certificate] = [format!("{name}.toml"), format!("{name}.cert.json")];
    fs::write(folder.0.path().join(&file), design).unwrap();
    if folder.run(&["verify", &file]) != Some(verdict) {
        return None;
    }
    assert_eq!(folder.run(&["report", &certificate]), Some(verdict));
    Some(folder.0.path().join(format!("{name}.report.html")))
}

/// The oracle's factors at a point, increasing.
pub fn psi(point: &Value) -> [f64; 3] {
    let xi = point["singular_values"].as_array().unwrap();
    let psi = |i: usize| 1.0 / xi[i].as_str().unwrap().parse::<f64>().unwrap();
    [psi(2), psi(1), psi(0)]
}

/// The least and the greatest factor that the prover's sampling finds at parts of the workspace.
pub fn psi_range(claim: &MachineClaim, u: [f64; 3]) -> [f64; 2] {
    let problem = Problem::new(claim).unwrap();
    let sampler = Sampler::new(claim, &problem).unwrap();
    assert_eq!(sampler.parts(&u), u, "outside the workspace");
    let place = Place { u: u.to_vec(), ..sampler.centre() };
    let [least, greatest] = sampler.xi(&sampler.at(&place)).unwrap();
    let angular = problem.legs.iter().any(Leg::is_angular);
    let unit = if angular { sampler.unit() } else { 1.0 };
    [unit / greatest, unit / least]
}

/// Parts of a workspace, within its cylinder if it is one.
pub fn places() -> Vec<[f64; 3]> {
    let mut all = Vec::new();
    for x in [0.15, 0.3, 0.5, 0.8] {
        for y in [0.2, 0.5, 0.8] {
            all.extend([0.0, 0.4, 1.0].map(|z| [x, y, z]));
        }
    }
    all
}

/// The numbers in a text, in order; indices of letters are none.
pub fn numbers(text: &str) -> Vec<f64> {
    let parts = text.split(|c: char| !(c.is_ascii_alphanumeric() || "+-.".contains(c)));
    parts.filter_map(|part| part.trim_end_matches('.').parse().ok()).collect()
}

/// Leaves a picture in the target folder.
pub fn kept(name: &str, kind: &str, bytes: &[u8]) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("report");
    fs::create_dir_all(&folder).unwrap();
    let file = if kind == "pdf" { format!("{name}.pdf") } else { format!("{name}.{kind}.png") };
    fs::write(folder.join(file), bytes).unwrap();
}
