//! Reports in a browser: what is drawn, read out, turned and moved, and that nothing is asked of a
//! network.
//!
//! Where there is no Chromium, or no Firefox, the tests say so and pass, unless `ORTHOCERT_BROWSER` is `required`.
//! The screenshots that they take stay in the target folder, under `tmp/report`.

mod chromium;
mod desk;
mod firefox;
mod support;

use chromium::Browser;
use support::{kept, numbers, report, Folder, PROVED};

/// Pages whose figures are all there, light and dark, without a word on the console.
#[test]
fn figures_are_drawn_light_and_dark_without_complaint() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = Folder::new();
    for (name, maps) in [
        ("orthoglide-prototype", 3),
        ("linear-delta-klipper-cylinder", 3),
        ("upu-struts", 3),
        ("rotary-delta-angle-refuted", 3),
        ("postulate-all", 0),
    ] {
        let page = folder.report_of_committed(name, &[]);
        browser.prefer("light");
        browser.open(&page);
        assert_eq!(browser.complaints(), Vec::<String>::new(), "{name}");
        let counted = |browser: &mut Browser, selector: &str| {
            browser.evaluate(&format!("document.querySelectorAll({selector:?}).length")).as_u64()
        };
        assert_eq!(counted(&mut browser, "svg[data-map] .field rect"), Some(maps), "{name}");
        assert_eq!(counted(&mut browser, "svg.design"), Some(maps / 3), "{name}");
        let light = browser.screenshot();
        browser.prefer("dark");
        let dark = browser.screenshot();
        kept(name, "light", &light);
        kept(name, "dark", &dark);
        assert!(browser.shades(&light) > 20 && browser.shades(&dark) > 20, "{name}: blank");
        assert!(browser.differ(&light, &dark) > 0.5, "{name}: light and dark look alike");
        assert_eq!(browser.complaints(), Vec::<String>::new(), "{name}");
    }
}

/// Pages of any mechanism: their figures, light and dark, and the boxes of three coordinates turned.
#[test]
fn any_mechanism_is_drawn_without_complaint() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = Folder::new();
    for (name, maps, spatial) in [
        ("four-struts", 4, true),
        ("four-sliders", 4, true),
        ("four-struts-refuted", 2, true),
        ("biglide", 2, false),
        ("four-coordinates", 3, false),
    ] {
        let page = folder.report_of_kernel(name);
        browser.prefer("light");
        browser.open(&page);
        let counted = |browser: &mut Browser, selector: &str| {
            browser.evaluate(&format!("document.querySelectorAll({selector:?}).length")).as_u64()
        };
        assert_eq!(counted(&mut browser, ".maps svg .field rect"), Some(maps), "{name}");
        assert_eq!(counted(&mut browser, "#space"), Some(u64::from(spatial)), "{name}");
        if spatial {
            let boxes = browser.text("#space-readout");
            assert!(boxes.contains("boxes; point at one") || boxes.contains("No boxes"), "{boxes}");
        }
        let shown =
            "getComputedStyle(document.querySelector('svg.subdivision').parentElement).display";
        let hidden = browser.evaluate(shown).as_str() == Some("none");
        assert_eq!(hidden, spatial, "{name}: the viewer, or the picture");
        let light = browser.screenshot();
        browser.prefer("dark");
        let dark = browser.screenshot();
        kept(name, "light", &light);
        kept(name, "dark", &dark);
        assert!(browser.differ(&light, &dark) > 0.5, "{name}: light and dark look alike");
        assert_eq!(browser.complaints(), Vec::<String>::new(), "{name}");
    }
}

/// The value under the pointer, and the value read by keys, are the oracle's.
#[test]
fn values_under_the_cross_are_the_oracles() {
    let Some(mut browser) = Browser::start() else { return };
    let oracle = include_str!("../../proofs/kernel/tests/oracle/points.json");
    let oracle: serde_json::Value = serde_json::from_str(oracle).unwrap();
    let mut read = 0;
    for case in oracle["cases"].as_array().unwrap() {
        let reachable = |p: &&serde_json::Value| p["reachable"] == true && p["det"] != "0";
        for point in case["points"].as_array().unwrap().iter().filter(reachable).take(2) {
            let folder = Folder::new();
            let Some(page) = folder.report_about(case, point) else { continue };
            browser.open(&page);
            let expected = support::psi(point);
            // The first press puts the cross in the middle, where the oracle's point is.
            browser.focus("svg[data-map='0']");
            browser.evaluate(
                "document.getElementById('slice').value = 100; \
                document.getElementById('slice').dispatchEvent(new Event('input'))",
            );
            browser.settle();
            browser.key("ArrowLeft");
            let by_key = browser.text("#map-readout");
            let frame = browser.evaluate(
                "(() => { const d = document.querySelector(\"svg[data-map='1']\").dataset; \
                 return [(Number(d.x) + Number(d.w) / 2) / 300, (Number(d.y) + Number(d.h) / 2) / 322]; })()",
            );
            let (x, y) = (frame[0].as_f64().unwrap(), frame[1].as_f64().unwrap());
            let at = browser.place("svg[data-map='1']", x, y);
            browser.pointer("mouseMoved", at, false);
            browser.settle();
            let by_pointer = browser.text("#map-readout");
            for text in [by_key, by_pointer] {
                let found = numbers(&text);
                assert_eq!(found.len(), 6, "{text}");
                for (found, expected) in found[3..].iter().zip(expected) {
                    assert!((found / expected - 1.0).abs() < 1e-6, "{text}: not {expected}");
                }
            }
            read += 1;
        }
    }
    assert!(read >= 6, "{read} points");
}

/// The script's formulas are those of the prover, for every drive.
#[test]
fn the_scripts_formulas_are_the_provers() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = Folder::new();
    for design in
        ["upu-struts", "rotary-delta-linuxcnc", "tripteron", "skew-guides", "orthoglide-as-built"]
    {
        let (page, claim) = folder.report_of_design(design);
        browser.open(&page);
        for u in support::places() {
            let expected = support::psi_range(&claim, u);
            let found = browser.evaluate(&format!(
                "(() => {{ const m = JSON.parse(document.getElementById('data').textContent).machine; \
                 const u = {u:?}; \
                 return factorsAt(m.legs, u.map((x, k) => m.least[k] + x * m.width[k])).psi; }})()"
            ));
            let (least, greatest) = (found[0].as_f64().unwrap(), found[2].as_f64().unwrap());
            for (found, expected) in [(least, expected[0]), (greatest, expected[1])] {
                assert!(
                    (found / expected - 1.0).abs() < 1e-9,
                    "{design} at {u:?}: {found}, {expected}"
                );
            }
        }
    }
}

/// The slider and the keys move the slice, and every map with it.
#[test]
fn the_slider_moves_the_slice() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = Folder::new();
    browser.open(&folder.report_of_committed("orthoglide-prototype", &[]));
    let drawn =
        "[...document.querySelectorAll('svg[data-map] .field')].map((f) => f.innerHTML).join()";
    assert_eq!(browser.text("#slice-value"), "z = -73.2051");
    let first = browser.evaluate(drawn);
    let (left, middle) = browser.place("#slice", 0.5, 0.5);
    for kind in ["mousePressed", "mouseReleased"] {
        browser.pointer(kind, (left, middle), kind == "mousePressed");
    }
    browser.settle();
    assert!(numbers(&browser.text("#slice-value"))[0] > 0.0);
    let second = browser.evaluate(drawn);
    assert_ne!(first, second);
    browser.focus("svg[data-map='2']");
    browser.key("PageUp");
    assert_ne!(browser.evaluate(drawn), second);
    browser.evaluate("document.getElementById('slice-reset').click()");
    browser.settle();
    assert_eq!(browser.text("#slice-value"), "z = -73.2051");
    // Through Q_1, at Q_1: one factor is 2, the others 0.8.
    browser.focus("svg[data-map='2']");
    for _ in 0..8 {
        browser.evaluate(
            "document.activeElement.dispatchEvent(new KeyboardEvent('keydown', \
            { key: 'ArrowLeft', shiftKey: true }))",
        );
        browser.evaluate(
            "document.activeElement.dispatchEvent(new KeyboardEvent('keydown', \
            { key: 'ArrowDown', shiftKey: true }))",
        );
    }
    let found = numbers(&browser.text("#map-readout"));
    assert_eq!(
        found[3..].iter().map(|x| (x * 1e6).round() / 1e6).collect::<Vec<_>>(),
        [0.8, 0.8, 2.0]
    );
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

/// The view in space turns by pointer and by keys, is cut, and tells of its boxes.
#[test]
fn the_view_in_space_turns_and_is_cut() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = Folder::new();
    browser.open(&folder.report_of_committed("orthoglide-prototype", &[]));
    let drawn = "document.getElementById('space').toDataURL()";
    let mut seen = vec![browser.evaluate(drawn)];
    let mut look = |browser: &mut Browser| {
        browser.settle();
        let now = browser.evaluate(drawn);
        assert!(!seen.contains(&now), "the picture is as it was");
        seen.push(now);
    };
    let (x, y) = browser.place("#space", 0.5, 0.5);
    browser.pointer("mouseMoved", (x, y), false);
    browser.settle();
    let told = browser.text("#space-readout");
    assert!(told.contains("\u{3c8}\u{1d62}") && told.contains(" by cube"), "{told}");
    assert!(told.contains("; ends rounded."), "{told}");
    browser.pointer("mousePressed", (x, y), true);
    browser.pointer("mouseMoved", (x + 60.0, y + 20.0), true);
    browser.pointer("mouseReleased", (x + 60.0, y + 20.0), false);
    look(&mut browser);
    for key in ["ArrowLeft", "ArrowUp", "+", "["] {
        browser.key(key);
        look(&mut browser);
    }
    browser.key("Enter");
    assert!(browser.text("#space-readout").starts_with("Box: x from "));
    for (id, value) in [("cut-axis", "2"), ("deep", "3"), ("obligation", "8")] {
        browser.evaluate(&format!(
            "(() => {{ const e = document.getElementById({id:?}); e.value = {value:?}; \
             e.dispatchEvent(new Event('input')); e.dispatchEvent(new Event('change')); }})()"
        ));
        look(&mut browser);
    }
    assert_eq!(browser.text("#deep-value"), "3: 2 boxes");
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

/// A refutation shows where; a hostile name stays a name.
#[test]
fn a_refutation_is_marked_and_hostile_text_stays_text() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = Folder::new();
    let hostile =
        "\"><script>window.hacked = 1</script><img src=x onerror='window.hacked = 2'>{{data}}";
    let page = folder.report_of_committed("orthoglide-310", &["--title", hostile]);
    browser.open(&page);
    assert_eq!(browser.text("h1"), hostile);
    assert_eq!(browser.evaluate("typeof window.hacked"), "undefined");
    assert_eq!(browser.evaluate("document.querySelectorAll('script').length"), 4);
    assert!(browser.text("svg.design").contains("counterexample"));
    assert!(browser.text("#counterexample").contains("greatest \u{3c8} \u{2264} 2"));
    assert!(browser.text(".verdict").contains("REFUTED"));
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

/// A page proves its claim again when it is opened, with the formally verified checker; one whose
/// certificate was edited says that it is rejected.
#[test]
fn a_page_proves_its_claim_again() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = Folder::new();
    for (name, verdict) in [
        ("orthoglide-prototype", "CERTIFIED"),
        ("linear-delta-klipper-cylinder", "CERTIFIED"),
        ("delta-joint-speed", "CERTIFIED"),
        ("rotary-delta-speed", "CERTIFIED"),
        ("planar-3-prr", "CERTIFIED"),
        ("postulate-all", "CERTIFIED"),
        ("delta-conditioning-refuted", "REFUTED"),
        ("star-singular", "REFUTED"),
        ("orthoglide-310-no-cube-of-200", "CERTIFIED"),
        ("spherical-3-ups", "CERTIFIED"),
        ("orthoglide-prototype-whole", "CERTIFIED"),
        ("orthoglide-atlas", "CERTIFIED"),
        ("orthoglide-as-built-tight", "CERTIFIED"),
    ] {
        let page = folder.report_of_committed(name, &[]);
        browser.open(&page);
        assert_eq!(browser.evaluate(PROVED), "accepted", "{name}");
        assert!(
            browser.text("#reproved").starts_with("This page proved its claim again"),
            "{name}"
        );
        assert!(browser.text(".verdict").contains(verdict), "{name}");
        assert_eq!(browser.complaints(), Vec::<String>::new(), "{name}");
        assert!(std::fs::metadata(&page).unwrap().len() < 620_000, "{name}");
    }
    // One digit of the claim is another; so is one of the proof.
    for (from, to) in
        [(r#"\"bound\":\"1.4\""#, r#"\"bound\":\"1.3\""#), (r#"\"places\":2"#, r#"\"places\":1"#)]
    {
        let page = folder.report_of_committed("linear-delta-klipper-cylinder", &[]);
        let text = std::fs::read_to_string(&page).unwrap();
        assert!(text.contains(from), "{from}");
        std::fs::write(&page, text.replacen(from, to, 1)).unwrap();
        browser.open(&page);
        assert_eq!(browser.evaluate(PROVED), "rejected", "{from}");
        assert!(browser.text(".verdict strong").contains("REJECTED"));
        kept("edited", "rejected", &browser.screenshot());
    }
    let page = folder.report_of_kernel("biglide");
    browser.open(&page);
    assert_eq!(browser.evaluate(PROVED), "accepted");
    let once =
        include_str!("../designs/kernel/planar-3-rpr.toml").to_owned() + "one_to_one = true\n";
    browser.open(&report(&folder, "one-to-one", &once, 0).unwrap());
    assert_eq!(browser.evaluate(PROVED), "accepted");
    // Accelerations of mechanisms by formulas the verified checker does not know.
    for (machine, proved) in [
        (include_str!("../designs/kernel/planar-3-prr.toml"), "accepted"),
        (include_str!("../designs/kernel/linear-delta-formulas.toml"), "not-covered"),
    ] {
        let asked = "joint_acceleration = { speed = 1, acceleration = 1, max = 1000 }\n";
        browser.open(&report(&folder, "accelerated", &(machine.to_owned() + asked), 0).unwrap());
        assert_eq!(browser.evaluate(PROVED), proved);
    }
    let why = browser.text("#reproved");
    assert!(
        why.contains("is not covered by the verified checker; the exact checker accepted"),
        "{why}"
    );
    assert!(browser.text(".verdict").contains("CERTIFIED"));
}

/// More than 7,000 boxes: small enough to send, and quick to turn.
#[test]
fn thousands_of_boxes_are_no_burden() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = Folder::new();
    let design = include_str!("many-boxes.toml");
    let page = report(&folder, "many-boxes", design, 0).unwrap();
    assert!(std::fs::metadata(&page).unwrap().len() < 5_000_000);
    browser.open(&page);
    let leaves = browser.evaluate(
        "JSON.parse(document.getElementById('data').textContent).trees[0].code.split('.').length - 1",
    );
    assert!(leaves.as_u64().unwrap() >= 7_000, "{leaves}");
    kept("many-boxes", "light", &browser.screenshot());
    browser.focus("#space");
    let start = std::time::Instant::now();
    for _ in 0..10 {
        browser.key("ArrowRight");
    }
    let each = start.elapsed() / 10;
    eprintln!("a turn of {leaves} boxes takes {each:?}");
    assert!(each.as_millis() < 1000, "{each:?}");
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

/// The region of a paving can be turned, cut and read, light and dark; without scripts it is drawn
/// from two sides.
#[test]
fn the_region_of_a_paving_is_turned_and_cut() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = Folder::new();
    let page = folder.report_of_paving("0.01");
    assert!(std::fs::metadata(&page).unwrap().len() < 5_000_000);
    browser.prefer("light");
    browser.open(&page);
    let light = browser.screenshot();
    browser.prefer("dark");
    let dark = browser.screenshot();
    kept("paving", "light", &light);
    kept("paving", "dark", &dark);
    assert!(
        browser.shades(&light) > 20
            && browser.shades(&dark) > 20
            && browser.differ(&light, &dark) > 0.5
    );
    let count = "Number(document.getElementById('region-space').dataset.faces)";
    let faces = browser.evaluate(count).as_u64().unwrap();
    assert!(faces > 2000, "{faces}");
    browser.focus("#region-space");
    // Half of it is cut away, and the cut goes through inner boxes.
    for _ in 0..25 {
        browser.key("[");
    }
    browser.settle();
    assert_eq!(browser.text("#region-cut-value"), "x \u{2264} 0");
    kept("paving", "cut", &browser.screenshot());
    browser.key("Enter");
    let text = browser.text("#region-readout");
    assert!(text.starts_with("Inner") && numbers(&text).len() == 6, "{text}");
    the_read_out_is_in_the_box(&mut browser);
    let start = std::time::Instant::now();
    for _ in 0..10 {
        browser.key("ArrowRight");
    }
    let each = start.elapsed() / 10;
    eprintln!("a turn of {faces} faces takes {each:?}");
    assert!(each.as_millis() < 1000, "{each:?}");
    let view = "document.getElementById('region-space').dataset.view";
    browser.settle();
    assert!(browser.evaluate(view).as_str().unwrap().starts_with("92.0"));
    assert_eq!(browser.complaints(), Vec::<String>::new());
    browser.call("Emulation.setScriptExecutionDisabled", serde_json::json!({ "value": true }));
    browser.open_still(&page);
    kept("paving", "without-scripts", &browser.screenshot());
    let drawn = "[...document.querySelectorAll('svg.figure.region, svg.figure.slices')]\
        .filter((s) => s.clientWidth > 0).length";
    assert_eq!(browser.evaluate(drawn).as_u64(), Some(2));
}

/// Of parts of the edge from -7/10 to 7/10, in 1024: the ends that are read out are the nearest decimals
/// of seven places that are in the part.
fn the_read_out_is_in_the_box(browser: &mut Browser) {
    let ends = "JSON.parse(document.getElementById('data').textContent).ends[1]";
    let all = browser.evaluate(&format!(
        "Array.from({{ length: 1024 }}, (_, k) => within({ends}, [k / 1024, (k + 1) / 1024], 7))"
    ));
    for k in 0..1024_i128 {
        let shown = |end: usize| {
            let text = all[k as usize][end].as_str().unwrap();
            (text.parse::<f64>().unwrap() * 1e7).round() as i128
        };
        // The ends in units of 10^-7 / 1024.
        let [low, high] = [k, k + 1].map(|k| (14 * k - 7 * 1024) * 1_000_000);
        let (from, to) = (1024 * shown(0), 1024 * shown(1));
        assert!(low <= from && from < low + 1024, "{k}: {from} {low}");
        assert!(high - 1024 < to && to <= high, "{k}: {to} {high}");
    }
}

/// Without scripts the static parts are there; on paper it has few pages.
#[test]
fn it_can_be_read_without_scripts_and_on_paper() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = Folder::new();
    let page = folder.report_of_committed("orthoglide-prototype", &[]);
    let drawn =
        "[...document.querySelectorAll('svg.figure')].filter((s) => s.clientWidth > 0).length";
    browser.open(&page);
    let with = browser.evaluate(drawn).as_u64().unwrap();
    let pdf = browser.pdf();
    kept("orthoglide-prototype", "pdf", &pdf);
    let text = String::from_utf8_lossy(&pdf);
    let pages = text.matches("/Type /Page\n").count();
    assert!((3..=8).contains(&pages), "{pages} pages");
    browser.call("Emulation.setScriptExecutionDisabled", serde_json::json!({ "value": true }));
    browser.open_still(&page);
    let without = browser.screenshot();
    kept("orthoglide-prototype", "without-scripts", &without);
    // The subdivision is drawn from two sides instead of in space.
    assert_eq!(browser.evaluate(drawn).as_u64(), Some(with + 1));
    browser.call("Emulation.setScriptExecutionDisabled", serde_json::json!({ "value": false }));
    assert!(browser.shades(&without) > 20);
}
