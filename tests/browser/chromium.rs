//! Headless Chromium, driven by its DevTools protocol over a pair of pipes.

use crate::support::{ended, on_path};
use data_encoding::BASE64;
use serde_json::{json, Value};
use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{channel, Receiver};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Longest wait for an answer.
const PATIENCE: Duration = Duration::from_secs(60);

/// A running browser with one page. It ends when this is dropped.
pub struct Browser {
    child: Child,
    commands: ChildStdin,
    messages: Receiver<Value>,
    events: VecDeque<Value>,
    session: Option<String>,
    sent: u64,
    _profile: TempDir,
}

impl Browser {
    /// A browser with an empty page of 1060 by 900 pixels.
    pub fn start() -> Option<Self> {
        let program = on_path("Chromium", &["chromium", "chromium-browser", "google-chrome"])?;
        let profile = tempfile::tempdir().unwrap();
        // The browser reads commands from its descriptor 3 and answers on 4.
        let mut command = Command::new("sh");
        command.args(["-c", "exec \"$0\" \"$@\" 3<&0 4>&1 0</dev/null 1>&2"]).arg(program);
        command.args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-quic",
            "--no-first-run",
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
            "--hide-scrollbars",
            "--window-size=1060,900",
            "--remote-debugging-pipe",
        ]);
        command.arg(format!("--user-data-dir={}", profile.path().display())).arg("about:blank");
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut child = command.spawn().unwrap();
        let (sender, messages) = channel();
        let answers = child.stdout.take().unwrap();
        std::thread::spawn(move || {
            for message in BufReader::new(answers).split(0).map_while(Result::ok) {
                let Ok(message) = serde_json::from_slice(&message) else { continue };
                if sender.send(message).is_err() {
                    break;
                }
            }
        });
        let commands = child.stdin.take().unwrap();
        let mut browser = Browser {
            child,
            commands,
            messages,
            events: VecDeque::new(),
            session: None,
            sent: 0,
            _profile: profile,
        };
        let target = browser.call("Target.createTarget", json!({ "url": "about:blank" }));
        let attached = browser.call(
            "Target.attachToTarget",
            json!({ "targetId": target["targetId"], "flatten": true }),
        );
        browser.session = attached["sessionId"].as_str().map(str::to_owned);
        for domain in ["Page", "Runtime", "Log", "Network"] {
            browser.call(&format!("{domain}.enable"), json!({}));
        }
        Some(browser)
    }

    fn next_message(&mut self, until: Instant) -> Value {
        let left = until.saturating_duration_since(Instant::now());
        self.messages.recv_timeout(left).expect("the browser answers")
    }

    /// Calls a method of the protocol and waits for its result.
    pub fn call(&mut self, method: &str, params: Value) -> Value {
        self.sent += 1;
        let mut message = json!({ "id": self.sent, "method": method, "params": params });
        if let Some(session) = &self.session {
            message["sessionId"] = json!(session);
        }
        let mut bytes = message.to_string().into_bytes();
        bytes.push(0);
        self.commands.write_all(&bytes).unwrap();
        let until = Instant::now() + PATIENCE;
        loop {
            let mut answer = self.next_message(until);
            if answer["id"] == self.sent {
                assert!(answer["error"].is_null(), "{method}: {}", answer["error"]);
                return answer["result"].take();
            }
            self.events.push_back(answer);
        }
    }

    /// Opens a file and waits until it is loaded and drawn.
    pub fn open(&mut self, file: &Path) {
        self.open_still(file);
        self.settle();
    }

    /// Opens a file and waits until it is loaded.
    pub fn open_still(&mut self, file: &Path) {
        self.events.clear();
        let url = format!("file://{}", file.display());
        self.call("Page.navigate", json!({ "url": url }));
        let until = Instant::now() + PATIENCE;
        while !self.events.iter().any(|event| event["method"] == "Page.loadEventFired") {
            let event = self.next_message(until);
            self.events.push_back(event);
        }
    }

    /// Waits until what was asked for is drawn.
    pub fn settle(&mut self) {
        self.evaluate(
            "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(0))))",
        );
    }

    /// The value of an expression in the page.
    pub fn evaluate(&mut self, expression: &str) -> Value {
        let params =
            json!({ "expression": expression, "returnByValue": true, "awaitPromise": true });
        let mut answer = self.call("Runtime.evaluate", params);
        assert!(answer["exceptionDetails"].is_null(), "{expression}: {answer}");
        answer["result"]["value"].take()
    }

    /// The text of the element that a selector finds.
    pub fn text(&mut self, selector: &str) -> String {
        let found = self.evaluate(&format!("document.querySelector({selector:?}).textContent"));
        found.as_str().unwrap().to_owned()
    }

    /// Where a part of an element is in the window, after scrolling to it.
    pub fn place(&mut self, selector: &str, x: f64, y: f64) -> (f64, f64) {
        let found = self.evaluate(&format!(
            "(() => {{ const e = document.querySelector({selector:?}); \
             e.scrollIntoView({{ block: 'center', behavior: 'instant' }}); \
             const b = e.getBoundingClientRect(); \
             return [b.left + {x} * b.width, b.top + {y} * b.height]; }})()"
        ));
        (found[0].as_f64().unwrap(), found[1].as_f64().unwrap())
    }

    /// Moves the pointer, presses or releases its button.
    pub fn pointer(&mut self, kind: &str, (x, y): (f64, f64), pressed: bool) {
        let left = pressed || kind == "mouseReleased";
        self.call(
            "Input.dispatchMouseEvent",
            json!({
                "type": kind, "x": x, "y": y, "button": if left { "left" } else { "none" },
                "buttons": u8::from(pressed), "clickCount": u8::from(kind != "mouseMoved"),
            }),
        );
    }

    /// Presses a key in the focused element.
    pub fn key(&mut self, key: &str) {
        for kind in ["keyDown", "keyUp"] {
            self.call("Input.dispatchKeyEvent", json!({ "type": kind, "key": key, "code": key }));
        }
        self.settle();
    }

    /// Types a text into the focused element, as pasting does.
    pub fn insert(&mut self, text: &str) {
        self.call("Input.insertText", json!({ "text": text }));
    }

    /// A window of another size.
    pub fn resize(&mut self, width: u32, height: u32) {
        let size = json!({
            "width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 500,
        });
        self.call("Emulation.setDeviceMetricsOverride", size);
        self.settle();
    }

    /// Where files go that pages give to keep.
    pub fn keep_in(&mut self, folder: &Path) {
        let to = json!({ "behavior": "allow", "downloadPath": folder });
        self.call("Page.setDownloadBehavior", to);
    }

    /// Focuses an element.
    pub fn focus(&mut self, selector: &str) {
        self.evaluate(&format!("document.querySelector({selector:?}).focus()"));
    }

    /// A light or a dark system.
    pub fn prefer(&mut self, scheme: &str) {
        let feature = json!([{ "name": "prefers-color-scheme", "value": scheme }]);
        self.call("Emulation.setEmulatedMedia", json!({ "features": feature }));
        self.settle();
    }

    /// The whole page as a PNG file.
    pub fn screenshot(&mut self) -> Vec<u8> {
        let params = json!({ "format": "png", "captureBeyondViewport": true });
        bytes(&self.call("Page.captureScreenshot", params)["data"])
    }

    /// How many colours a picture has, of 4096.
    pub fn shades(&mut self, png: &[u8]) -> u64 {
        let pixels = pixels(png);
        let coarse = "new Set(pixels.map((c) => c & 0xf0f0f0)).size";
        let found = self.evaluate(&format!("{pixels}.then((pixels) => {coarse})"));
        found.as_u64().unwrap()
    }

    /// The part of two pictures' pixels that differ.
    pub fn differ(&mut self, one: &[u8], other: &[u8]) -> f64 {
        let (one, other) = (pixels(one), pixels(other));
        let part = "one.filter((c, i) => c !== other[i]).length / one.length";
        let both = format!("Promise.all([{one}, {other}])");
        self.evaluate(&format!("{both}.then(([one, other]) => {part})")).as_f64().unwrap()
    }

    /// The page as it is printed on A4.
    pub fn pdf(&mut self) -> Vec<u8> {
        let params = json!({ "preferCSSPageSize": true, "printBackground": true });
        bytes(&self.call("Page.printToPDF", params)["data"])
    }

    /// What the console and the log say since the page was opened, and what was asked of a network.
    pub fn complaints(&mut self) -> Vec<String> {
        self.evaluate("0");
        let said = |event: &Value| match event["method"].as_str() {
            Some("Runtime.exceptionThrown" | "Runtime.consoleAPICalled" | "Log.entryAdded") => {
                Some(event["params"].to_string())
            }
            Some("Network.requestWillBeSent") => {
                let url = event["params"]["request"]["url"].as_str().unwrap_or("");
                let is_own = ["file://", "blob:"].iter().any(|own| url.starts_with(own));
                (!is_own).then(|| format!("asks for {url}"))
            }
            _ => None,
        };
        self.events.iter().filter_map(said).collect()
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // Its own way first, so that its processes end with it.
        let _ = self.commands.write_all(b"{\"id\":0,\"method\":\"Browser.close\"}\0");
        ended(&mut self.child);
    }
}

/// A file, as the protocol carries it.
fn bytes(data: &Value) -> Vec<u8> {
    BASE64.decode(data.as_str().unwrap().as_bytes()).unwrap()
}

/// An expression for the pixels of a PNG file.
fn pixels(png: &[u8]) -> String {
    let text = BASE64.encode(png);
    format!(
        "(async () => {{ \
         const bytes = Uint8Array.from(atob('{text}'), (c) => c.charCodeAt(0)); \
         const map = await createImageBitmap(new Blob([bytes], {{ type: 'image/png' }})); \
         const canvas = new OffscreenCanvas(map.width, map.height); \
         const context = canvas.getContext('2d', {{ willReadFrequently: true }}); \
         context.drawImage(map, 0, 0); \
         const {{ data }} = context.getImageData(0, 0, map.width, map.height); \
         return new Uint32Array(data.buffer); }})()"
    )
}
