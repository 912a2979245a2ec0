//! Headless Firefox, driven by its Marionette protocol: texts with their length before them, over a
//! socket.

use crate::support::{ended, kept, on_path, Folder, PROVED};
use data_encoding::BASE64;
use serde_json::{json, Value};
use std::fs::{self, File};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Longest wait for an answer.
const PATIENCE: Duration = Duration::from_secs(60);

/// A running browser with one page. It ends when this is dropped.
pub struct Firefox {
    child: Child,
    stream: BufReader<TcpStream>,
    sent: u64,
    profile: TempDir,
}

impl Firefox {
    /// A browser with an empty page.
    pub fn start() -> Option<Self> {
        let program = on_path("Firefox", &["firefox", "firefox-esr"])?;
        let profile = tempfile::tempdir().unwrap();
        // Any free port, which is told in the profile; errors of pages go to standard error.
        let settings = "user_pref(\"marionette.port\", 0);\n\
                        user_pref(\"browser.dom.window.dump.enabled\", true);\n\
                        user_pref(\"app.normandy.enabled\", false);\n";
        fs::write(profile.path().join("user.js"), settings).unwrap();
        let mut command = Command::new(program);
        command.args(["--headless", "--no-remote", "--marionette", "--profile"]);
        command.arg(profile.path()).env("MOZ_HEADLESS_WIDTH", "1060");
        let said = File::create(profile.path().join("said")).unwrap();
        let mut child =
            command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(said).spawn().unwrap();
        let until = Instant::now() + PATIENCE;
        let port = loop {
            let told = fs::read_to_string(profile.path().join("MarionetteActivePort"));
            if let Some(port) = told.ok().and_then(|told| told.trim().parse::<u16>().ok()) {
                break port;
            }
            if Instant::now() > until {
                let _ = child.kill();
                panic!("Firefox does not open a port");
            }
            std::thread::sleep(Duration::from_millis(20));
        };
        let stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        let mut firefox = Firefox { child, stream: BufReader::new(stream), sent: 0, profile };
        assert_eq!(firefox.message()["marionetteProtocol"], 3);
        firefox.call("WebDriver:NewSession", json!({}));
        Some(firefox)
    }

    fn message(&mut self) -> Value {
        let mut length = Vec::new();
        self.stream.read_until(b':', &mut length).expect("the browser answers");
        length.pop();
        let length: usize = String::from_utf8(length).unwrap().parse().unwrap();
        let mut bytes = vec![0; length];
        self.stream.read_exact(&mut bytes).unwrap();
        serde_json::from_slice(&bytes).unwrap()
    }

    fn send(&mut self, command: &str, params: &Value) {
        self.sent += 1;
        let text = json!([0, self.sent, command, params]).to_string();
        write!(self.stream.get_mut(), "{}:{text}", text.len()).unwrap();
    }

    /// Calls a command and waits for its result.
    fn call(&mut self, command: &str, params: Value) -> Value {
        self.send(command, &params);
        let mut answer = self.message();
        assert_eq!(answer[1], self.sent, "{command}");
        assert!(answer[2].is_null(), "{command}: {}", answer[2]);
        let result = answer[3].take();
        result.get("value").cloned().unwrap_or(result)
    }

    /// Opens a file and waits until it is loaded.
    pub fn open(&mut self, file: &Path) {
        self.call("WebDriver:Navigate", json!({ "url": format!("file://{}", file.display()) }));
    }

    /// The value of an expression about the page's elements, when it is there. What the page's
    /// scripts declare is out of its sight.
    pub fn evaluate(&mut self, expression: &str) -> Value {
        let script = format!("Promise.resolve({expression}).then(arguments[0])");
        let params = json!({ "script": script, "args": [], "scriptTimeout": 60_000 });
        self.call("WebDriver:ExecuteAsyncScript", params)
    }

    /// The text of the element that a selector finds.
    pub fn text(&mut self, selector: &str) -> String {
        let found = self.evaluate(&format!("document.querySelector({selector:?}).textContent"));
        found.as_str().unwrap().to_owned()
    }

    /// Presses the pointer's button at a place in the window, moves it by steps to the right, and
    /// releases it.
    pub fn drag(&mut self, (x, y): (f64, f64), steps: &[f64]) {
        let to = |x: f64| json!({ "type": "pointerMove", "x": x.round(), "y": y.round() });
        let mut actions = vec![to(x), json!({ "type": "pointerDown", "button": 0 })];
        actions.extend(steps.iter().map(|step| to(x + step)));
        actions.push(json!({ "type": "pointerUp", "button": 0 }));
        let mouse = json!([{ "type": "pointer", "id": "mouse", "actions": actions }]);
        self.call("WebDriver:PerformActions", json!({ "actions": mouse }));
    }

    /// The whole page as a PNG file.
    pub fn screenshot(&mut self) -> Vec<u8> {
        let data = self.call("WebDriver:TakeScreenshot", json!({ "full": true }));
        BASE64.decode(data.as_str().unwrap().as_bytes()).unwrap()
    }

    /// The errors that pages ended with.
    pub fn complaints(&mut self) -> Vec<String> {
        self.evaluate("0");
        let said = fs::read_to_string(self.profile.path().join("said")).unwrap();
        let own = said.lines().filter(|line| line.starts_with("JavaScript error: file://"));
        own.map(str::to_owned).collect()
    }
}

impl Drop for Firefox {
    fn drop(&mut self) {
        // Its own way first, so that its processes end with it.
        self.send("Marionette:Quit", &json!({ "flags": ["eForceQuit"] }));
        ended(&mut self.child);
    }
}

/// Reports: the same figures as in Chromium, no error, and each proves its claim again; one whose
/// certificate was edited is rejected.
#[test]
fn reports_are_drawn_and_prove_their_claims() {
    let Some(mut firefox) = Firefox::start() else { return };
    let folder = Folder::new();
    for (name, maps) in [
        ("linear-delta-klipper-cylinder", 3),
        ("postulate-all", 0),
        ("delta-conditioning-refuted", 3),
        ("spherical-3-ups", 0),
    ] {
        let page = folder.report_of_committed(name, &[]);
        firefox.open(&page);
        assert_eq!(firefox.evaluate(PROVED), "accepted", "{name}");
        assert!(firefox.text("#reproved").starts_with("This page proved its claim again"));
        let drawn = "document.querySelectorAll('svg[data-map] .field rect').length";
        assert_eq!(firefox.evaluate(drawn), maps, "{name}");
        kept(name, "firefox", &firefox.screenshot());
    }
    let page = folder.report_of_committed("linear-delta-klipper-cylinder", &[]);
    let text = fs::read_to_string(&page).unwrap();
    let [from, to] = [r#"\"bound\":\"1.4\""#, r#"\"bound\":\"1.3\""#];
    assert!(text.contains(from));
    fs::write(&page, text.replacen(from, to, 1)).unwrap();
    firefox.open(&page);
    assert_eq!(firefox.evaluate(PROVED), "rejected");
    assert!(firefox.text(".verdict strong").contains("REJECTED"));
    assert_eq!(firefox.complaints(), Vec::<String>::new());
}

/// The page that proves while a number is dragged.
#[test]
fn a_drag_is_proved() {
    let Some(page) = std::env::var_os("ORTHOCERT_DESK") else {
        eprintln!("skipped: ORTHOCERT_DESK names no page of src/desk/build.sh");
        return;
    };
    let Some(mut firefox) = Firefox::start() else { return };
    firefox.open(Path::new(&page));
    // A verdict of this kind, about a design in whose text this stands.
    let shown = |firefox: &mut Firefox, state: &str, part: &str| {
        let until = Instant::now() + PATIENCE;
        let now = "(() => { const v = document.getElementById('verdict'); \
                   return [v.dataset.state, v.classList.contains('pending'), \
                   document.getElementById('text').value]; })()";
        loop {
            let found = firefox.evaluate(now);
            let is_there = found[2].as_str().unwrap().contains(part);
            if found[0] == state && found[1] == false && is_there {
                return;
            }
            assert!(Instant::now() < until, "{state}: {found}");
            std::thread::sleep(Duration::from_millis(10));
        }
    };
    shown(&mut firefox, "certified", "");
    firefox.evaluate(
        "(() => { const m = document.getElementById('machine'); \
         m.value = 'linear-delta-klipper-cylinder.toml'; m.dispatchEvent(new Event('change')); })()",
    );
    shown(&mut firefox, "certified", "333");
    let place = firefox.evaluate(
        "(() => { const label = [...document.querySelectorAll('.slider label')] \
         .find((label) => label.textContent === 'workspace.cylinder.radius'); \
         const e = document.getElementById(label.htmlFor); \
         e.scrollIntoView({ block: 'center', behavior: 'instant' }); \
         const b = e.getBoundingClientRect(); return [b.left + b.width / 2, b.top + b.height / 2]; })()",
    );
    let place = (place[0].as_f64().unwrap(), place[1].as_f64().unwrap());
    firefox.drag(place, &[-10.0, -20.0]);
    shown(&mut firefox, "certified", "radius = 7");
    firefox.drag((place.0 - 20.0, place.1), &[60.0, 120.0]);
    shown(&mut firefox, "refuted", "radius = ");
    kept("desk", "firefox", &firefox.screenshot());
    assert!(firefox.text("#drawing").contains("counterexample"));
    assert_eq!(firefox.complaints(), Vec::<String>::new());
}
