//! The page that proves while a number is dragged, which `src/desk/build.sh` wrote: verdicts on drags,
//! refusals, the back button, keys, a phone's width, files to keep.
//!
//! `ORTHOCERT_DESK` names the page; without it these tests say so and pass.

use crate::chromium::Browser;
use crate::support::{kept, Folder};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Longest wait for a verdict.
const PATIENCE: Duration = Duration::from_secs(40);

/// The page in a browser, with its first verdict.
struct Desk {
    browser: Browser,
}

impl Desk {
    fn open() -> Option<Self> {
        let Some(page) = std::env::var_os("ORTHOCERT_DESK").map(PathBuf::from) else {
            eprintln!("skipped: ORTHOCERT_DESK names no page of src/desk/build.sh");
            return None;
        };
        let mut browser = Browser::start()?;
        browser.resize(1280, 1000);
        browser.open(&page);
        let mut desk = Desk { browser };
        desk.wait("desk.answer");
        Some(desk)
    }

    /// Waits until an expression holds.
    fn wait(&mut self, expression: &str) {
        let until = Instant::now() + PATIENCE;
        while self.browser.evaluate(&format!("Boolean({expression})")) != true {
            assert!(Instant::now() < until, "{expression}: {}", self.browser.text("#verdict"));
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    /// Waits for the answer to what is on the desk; its state.
    fn answer(&mut self) -> String {
        self.wait("desk.answer && desk.answer.text === desk.text && !prover.busy && !desk.unread");
        self.browser.evaluate("at('verdict').dataset.state").as_str().unwrap().to_owned()
    }

    /// Chooses a machine.
    fn choose(&mut self, file: &str) -> String {
        self.browser.evaluate(&format!(
            "at('machine').value = '{file}.toml'; at('machine').dispatchEvent(new Event('change'))"
        ));
        self.answer()
    }

    /// The selector of a number's slider.
    fn slider(&mut self, key: &str) -> String {
        let found = self.browser.evaluate(&format!(
            "rows.all[desk.numbers.findIndex((number) => number.key === {key:?})].input.id"
        ));
        format!("#{}", found.as_str().unwrap())
    }

    fn text(&mut self) -> String {
        self.browser.evaluate("desk.text").as_str().unwrap().to_owned()
    }

    /// Takes the place of the design's text, as pasting does.
    fn paste(&mut self, text: &str) -> String {
        self.browser.focus("#text");
        self.browser.evaluate("at('text').select()");
        self.browser.insert(text);
        self.answer()
    }
}

/// A drag gives verdicts on the way, each of the design as it stands in the text; the drawing marks
/// the counterexample; the back button leads to the design before it.
#[test]
fn a_drag_is_proved_on_its_way_and_can_be_taken_back() {
    let Some(mut desk) = Desk::open() else { return };
    assert_eq!(desk.choose("linear-delta-klipper-cylinder"), "certified");
    let first = desk.text();
    let slider = desk.slider("workspace.cylinder.radius");
    let middle = desk.browser.place(&slider, 0.5, 0.5);
    let to = |part: f64| (middle.0 + part, middle.1);
    desk.browser.pointer("mousePressed", middle, true);
    desk.browser.pointer("mouseMoved", to(-20.0), true);
    assert_eq!(desk.answer(), "certified");
    assert!(desk.text().contains("radius = 7"), "{}", desk.text());
    desk.browser.pointer("mouseMoved", to(100.0), true);
    assert_eq!(desk.answer(), "refuted");
    desk.browser.pointer("mouseReleased", to(100.0), false);
    desk.browser.settle();
    assert!(desk.browser.text("#drawing").contains("counterexample"));
    let said = desk.browser.text("#meaning");
    assert!(said.contains("is violated: ") && said.contains(" at ("), "{said}");
    // The verdict is the command line's on the very text.
    let folder = Folder::new();
    std::fs::write(folder.path().join("design.toml"), desk.text()).unwrap();
    assert_eq!(folder.said(&["verify", "design.toml", "--quiet"]).1, Some(1));
    desk.browser.evaluate("history.back()");
    desk.wait("location.hash === '#machine=linear-delta-klipper-cylinder'");
    assert_eq!(desk.answer(), "certified");
    assert_eq!(desk.text(), first);
    desk.browser.evaluate("history.forward()");
    desk.wait("location.hash.includes('&design=')");
    assert_eq!(desk.answer(), "refuted");
    assert_eq!(desk.browser.complaints(), Vec::<String>::new());
}

/// What is no design is refused with the sentence of the command line, and nothing stays of the
/// verdict before it.
#[test]
fn what_is_pasted_is_refused_as_on_the_command_line() {
    let Some(mut desk) = Desk::open() else { return };
    let folder = Folder::new();
    let good = desk.text();
    let hostile = "title = \"<img src=x onerror='window.hacked = 1'>\"\n";
    for bad in [
        "not a design",
        &good.replace("cube = 200", "cube = -200"),
        &good.replace("cube = 200", "cubes = 200"),
        &good.replace("max = 2", "max = \"2 +0.1 -0.1\""),
        hostile,
    ] {
        assert_eq!(desk.paste(bad), "refused", "{bad}");
        let shown = desk.browser.text("#refusal");
        std::fs::write(folder.path().join("orthoglide-prototype.toml"), bad).unwrap();
        let (said, code) = folder.said(&["verify", "orthoglide-prototype.toml"]);
        assert_eq!(code, Some(2), "{bad}");
        assert!(said.trim_end().ends_with(shown.trim_end()), "{said}\n{shown}");
        assert!(shown.contains('^'), "{shown}");
        assert_eq!(desk.browser.evaluate("at('keep-certificate').disabled"), true);
    }
    assert_eq!(desk.browser.evaluate("typeof window.hacked"), "undefined");
    kept("desk", "refused", &desk.browser.screenshot());
    assert_eq!(desk.paste(&good), "certified");
    assert_eq!(desk.browser.complaints(), Vec::<String>::new());
}

/// With keys alone: a machine is chosen, a number moved until the verdict changes.
#[test]
fn keys_alone_will_do() {
    let Some(mut desk) = Desk::open() else { return };
    let focused = "document.activeElement.id";
    let mut reached = Vec::new();
    for _ in 0..12 {
        desk.browser.key("Tab");
        let id = desk.browser.evaluate(focused).as_str().unwrap().to_owned();
        if id.starts_with("number-") {
            break;
        }
        reached.push(id);
    }
    assert!(reached.contains(&"machine".to_owned()), "{reached:?}");
    let slider = desk.slider("workspace.cube");
    assert_eq!(format!("#{}", desk.browser.evaluate(focused).as_str().unwrap()), slider);
    let before = desk.browser.evaluate("desk.numbers[0].value");
    assert_eq!(before, "200");
    desk.browser.key("ArrowRight");
    assert_eq!(desk.answer(), "certified");
    assert_eq!(desk.browser.evaluate("desk.numbers[0].value"), "200.1");
    assert!(desk.text().contains("cube = 200.1\n"), "{}", desk.text());
    desk.browser.key("PageDown");
    desk.answer();
    assert_eq!(desk.browser.evaluate("desk.numbers[0].value"), "192.1");
    assert_eq!(
        desk.browser.evaluate("document.activeElement.getAttribute('aria-valuetext')"),
        "192.1"
    );
    assert_eq!(desk.browser.complaints(), Vec::<String>::new());
}

/// At 390 pixels nothing sticks out, and the verdict is seen beside the slider that is moved.
#[test]
fn it_fits_a_phone() {
    let Some(mut desk) = Desk::open() else { return };
    for (machine, width) in
        [("linear-delta-klipper-cylinder", 390), ("hexapod-linuxcnc", 390), ("planar-3-rpr", 1280)]
    {
        desk.browser.resize(width, 844);
        desk.choose(machine);
        desk.wait("at('figures').getAttribute('aria-busy') === 'false' && desk.drawn === desk.answer.certificate");
        assert_eq!(desk.browser.evaluate("document.documentElement.scrollWidth"), width);
        for scheme in ["light", "dark"] {
            desk.browser.prefer(scheme);
            kept(&format!("desk-{machine}"), scheme, &desk.browser.screenshot());
        }
        let slider = desk.slider("requirements.transmission.max");
        let (_, y) = desk.browser.place(&slider, 0.5, 0.5);
        let seen = "(() => { const b = at('headline').getBoundingClientRect(); return [b.top, b.bottom]; })()";
        let [top, bottom] = [0, 1].map(|k| desk.browser.evaluate(seen)[k].as_f64().unwrap());
        assert!(top >= 0.0 && bottom < y, "{machine}: {top} {bottom} {y}");
    }
    assert_eq!(desk.browser.complaints(), Vec::<String>::new());
}

/// The files to keep are those of the command line: it accepts the certificate as the design's.
#[test]
fn what_is_kept_is_accepted_by_the_command_line() {
    let Some(mut desk) = Desk::open() else { return };
    let folder = Folder::new();
    desk.browser.keep_in(folder.path());
    desk.choose("linear-delta-linuxcnc-cylinder");
    let slider = desk.slider("workspace.cylinder.radius");
    desk.browser.focus(&slider);
    desk.browser.key("ArrowLeft");
    assert_eq!(desk.answer(), "certified");
    let name = |end: &str| format!("linear-delta-linuxcnc-cylinder{end}");
    let files = [".toml", ".cert.json", ".report.html"].map(name);
    for (what, file) in ["design", "certificate", "report"].iter().zip(&files) {
        desk.browser.evaluate(&format!("at('keep-{what}').click()"));
        let until = Instant::now() + PATIENCE;
        while !folder.path().join(file).is_file() {
            assert!(Instant::now() < until, "{file}");
            std::thread::sleep(Duration::from_millis(20));
        }
    }
    let (said, code) = folder.said(&["check", &files[1], "--design", &files[0]]);
    assert_eq!(code, Some(0), "{said}");
    let report = std::fs::read_to_string(folder.path().join(&files[2])).unwrap();
    assert!(report.contains("CERTIFIED") && report.ends_with("</html>\n"));
    desk.browser.evaluate("at('find').click()");
    desk.wait("at('found').querySelector('.limit')");
    let found = desk.browser.text("#found");
    assert!(found.contains("Upper limit") && found.contains("limited by"), "{found}");
    kept("desk", "limits", &desk.browser.screenshot());
    assert_eq!(desk.browser.complaints(), Vec::<String>::new());
}

/// The page answers to its user while a proof takes long, and gives it up for a newer number.
#[test]
fn a_long_proof_does_not_stall_the_page() {
    let Some(mut desk) = Desk::open() else { return };
    let text = include_str!("many-boxes.toml");
    desk.browser.focus("#text");
    desk.browser.evaluate("at('text').select()");
    desk.browser.insert(text);
    desk.wait("prover.busy && at('verdict').classList.contains('pending')");
    let start = Instant::now();
    desk.browser.settle();
    assert!(start.elapsed() < Duration::from_secs(1), "{:?}", start.elapsed());
    let prototype = include_str!("../designs/orthoglide-prototype.toml");
    let start = Instant::now();
    assert_eq!(desk.paste(prototype), "certified");
    assert!(start.elapsed() < Duration::from_secs(5), "{:?}", start.elapsed());
    assert_eq!(desk.browser.complaints(), Vec::<String>::new());
}

/// From a drag to the verdict on the screen: told, and bounded generously, as machines differ.
#[test]
fn verdicts_come_while_a_number_is_dragged() {
    let Some(mut desk) = Desk::open() else { return };
    desk.browser.evaluate(
        "window.times = []; window.begun = 0; \
         addEventListener('input', (e) => { begun = begun || e.timeStamp; }, true); \
         new MutationObserver(() => { const from = begun; begun = 0; \
         if (from) requestAnimationFrame(() => times.push(performance.now() - from)); }) \
         .observe(at('verdict'), { attributes: true, attributeFilter: ['data-shown'] }); 0",
    );
    for (machine, key) in [
        ("orthoglide-prototype", "workspace.cube"),
        ("linear-delta-klipper-cylinder", "workspace.cylinder.radius"),
        ("rotary-delta-linuxcnc", "workspace.cylinder.radius"),
        ("hexapod-linuxcnc", "workspace.orientation.angle"),
    ] {
        desk.choose(machine);
        let slider = desk.slider(key);
        let (x, y) = desk.browser.place(&slider, 0.5, 0.5);
        desk.browser.evaluate("times.length = 0");
        desk.browser.pointer("mousePressed", (x, y), true);
        for step in 1..=20 {
            desk.browser.pointer("mouseMoved", (x - f64::from(step), y), true);
            desk.answer();
        }
        desk.browser.pointer("mouseReleased", (x - 20.0, y), false);
        desk.browser.settle();
        let mut times: Vec<f64> = serde_json::from_value(desk.browser.evaluate("times")).unwrap();
        times.sort_by(f64::total_cmp);
        assert!(times.len() >= 10, "{machine}: {times:?}");
        let (median, greatest) = (times[times.len() / 2], times[times.len() - 1]);
        eprintln!("{machine}: {median:.0} ms from a drag to the verdict, at most {greatest:.0}");
        assert!(median < 3000.0, "{machine}: {median}");
    }
}
