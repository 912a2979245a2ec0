use super::*;
use crate::search::accepted::check;
use orthocert_checker::read;

fn certificate(name: &str) -> Vec<u8> {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    std::fs::read(root.join(format!("proofs/certificates/{name}.cert.json"))).unwrap()
}

fn with_page<T>(bytes: &[u8], title: Option<&str>, look: impl Fn(&Page<'_>) -> T) -> T {
    let certificate = read(bytes).unwrap();
    let accepted = check(&certificate).unwrap();
    let file = File { name: "it's <b>.cert.json", bytes };
    look(&Page::new(&certificate, &accepted, file, title, Some("mm")))
}

#[test]
fn a_page_is_a_function_of_the_certificate_and_its_names() {
    let bytes = certificate("orthoglide-prototype");
    let [one, other] = [(); 2].map(|()| with_page(&bytes, None, |page| page.html()));
    assert_eq!(one, other);
    assert!(one.len() < 1_000_000);
    assert!(one.contains("CERTIFIED") && one.contains("310.582854"));
    // It asks for nothing: no address but those of namespaces.
    assert!(
        !one.contains("http://")
            || one.matches("http://").count() == one.matches("http://www.w3.org/2000/svg").count()
    );
    assert!(!one.contains("https://") && !one.contains("@import") && !one.contains("src="));
}

#[test]
fn a_caption_names_what_is_drawn() {
    for (name, there, not_there) in [
        ("five-bar", "arms from A<sub>i</sub> to B<sub>i</sub>, legs", "dash-dotted"),
        ("rotary-delta-speed", "axes of the motors dash-dotted, arms", "guides"),
        ("linear-delta-klipper-cylinder", "guides dash-dotted, legs", "arms"),
        ("hexapod-linuxcnc", "tolerance): legs from B<sub>i</sub>", "dash-dotted"),
    ] {
        let page = with_page(&certificate(name), None, |page| page.html());
        let caption = page
            .split("<figcaption>The nominal machine")
            .nth(1)
            .and_then(|s| s.split("</fig").next());
        let caption = caption.unwrap();
        assert!(caption.contains(there) && !caption.contains(not_there), "{name}: {caption}");
        assert_eq!(page.contains("<td>axis</td>"), name == "rotary-delta-speed");
    }
}

#[test]
fn directions_are_those_of_motions() {
    for (name, moves) in
        [("delta-conditioning-refuted", true), ("rotary-delta-angle-refuted", false)]
    {
        let page = with_page(&certificate(name), None, |page| page.html());
        assert_eq!(page.contains("moving along"), moves, "{name}");
    }
}

#[test]
fn names_and_titles_stay_text() {
    let bytes = certificate("orthoglide-310");
    let text = String::from_utf8(bytes).unwrap();
    let hostile =
        text.replace("\"tool\":\"orthocert\"", "\"tool\":\"<img src=x onerror=alert(1)>\"");
    let title = "</title><script>alert('{{data}}')</script>";
    let page = with_page(hostile.as_bytes(), Some(title), |page| page.html());
    assert!(!page.contains("<script>alert") && !page.contains("<img") && !page.contains("<b>"));
    assert!(page.contains("&lt;script&gt;alert(&#39;{{data}}&#39;)&lt;/script&gt;"));
    assert!(page.contains("it&#39;\\&#39;&#39;s &lt;b&gt;.cert.json&#39;"));
}

#[test]
fn every_committed_certificate_has_a_page() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("proofs/certificates");
    for entry in std::fs::read_dir(folder).unwrap() {
        let bytes = std::fs::read(entry.unwrap().path()).unwrap();
        with_page(&bytes, None, |page| {
            let html = page.html();
            let json = html.split("id=\"data\">").nth(1).and_then(|s| s.split("</script>").next());
            let data: Value = serde_json::from_str(json.unwrap()).unwrap();
            // The viewer in space takes three coordinates; other machines have projections.
            let in_space = !matches!(page.certificate.claim, Claim::Machine(_));
            assert!(!in_space || !data["trees"].as_array().unwrap().is_empty());
            for picture in page.pictures() {
                let file = picture.file();
                assert!(file.ends_with("</svg>\n") && !file.contains("var("), "{}", picture.name);
                assert!(!file.contains("NaN") && !file.contains("inf"), "{}", picture.name);
            }
        });
    }
}

/// The paper's last figure: through `Q_1`, where one factor is 2; at `Q_2` one is 1/2, at `O` all
/// are 1.
#[test]
fn the_factors_of_the_prototype_are_the_papers() {
    let bytes = certificate("orthoglide-prototype");
    with_page(&bytes, None, |page| {
        let (machine, _) = page.machine.as_ref().unwrap();
        assert_eq!(machine.slice, 0.0);
        let near = |p: [f64; 3], expected: [f64; 3]| {
            let psi = machine.psi(p).unwrap();
            assert!(psi.iter().zip(expected).all(|(x, y)| (x - y).abs() < 1e-9), "{psi:?}");
        };
        near([0.0; 3], [1.0; 3]);
        near(machine.point([0.0; 3]), [0.8, 0.8, 2.0]);
        near(machine.point([1.0; 3]), [0.5, 2.0, 2.0]);
    });
}

#[test]
fn what_does_not_apply_is_left_out_with_a_word() {
    let page = with_page(&certificate("postulate-all"), None, |page| page.html());
    assert!(page.contains("There is no drawing, and no map") && !page.contains("data-map="));
    assert_eq!(page.matches("class=\"figure subdivision").count(), 4);
    let page = with_page(&certificate("orthoglide-310"), None, |page| page.html());
    assert!(page.contains("needs one point and no subdivision"));
    assert!(page.contains("634/5") || page.contains("126.8"));
}

/// A certificate of the kernel.
fn of_kernel(name: &str) -> Vec<u8> {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    std::fs::read(root.join(format!("tests/kernel/{name}.cert.json"))).unwrap()
}

#[test]
fn any_mechanism_has_its_figures() {
    for (name, figures) in [
        (
            "four-struts",
            &["design", "psi-1", "critical-1", "psi-2", "critical-2", "subdivision"][..],
        ),
        ("four-sliders", &["design", "psi-1", "critical-1", "psi-2", "critical-2", "subdivision"]),
        ("four-struts-refuted", &["design", "psi-1", "psi-2", "subdivision"]),
        ("biglide", &["psi-1", "critical-1", "subdivision"]),
        ("four-coordinates", &["psi-1", "psi-2", "psi-3", "subdivision"]),
    ] {
        let bytes = of_kernel(name);
        with_page(&bytes, Some("<i>{{data}}"), |page| {
            let names: Vec<&str> = page.pictures().map(|p| p.name.as_str()).collect();
            assert_eq!(names, figures, "{name}");
            for picture in page.pictures() {
                let file = picture.file();
                assert!(!file.contains("NaN") && !file.contains("inf"), "{name}: {}", picture.name);
                assert!(!file.contains("var("), "{name}: {}", picture.name);
            }
            let html = page.html();
            assert!(html.contains("&lt;i&gt;{{data}}") && !html.contains("<i>{{"), "{name}");
            assert!(html.contains("<dt>machine</dt><dd>"), "{name}: the first box");
            assert_eq!(html, page.html(), "{name}");
            // What a script turns has three coordinates.
            let spatial = !matches!(name, "biglide" | "four-coordinates");
            assert_eq!(html.contains("id=\"space\""), spatial, "{name}");
            let json = html.split("id=\"data\">").nth(1).and_then(|s| s.split("</script>").next());
            let data: Value = serde_json::from_str(json.unwrap()).unwrap();
            assert_eq!(data["trees"].as_array().unwrap().len(), usize::from(spatial), "{name}");
        });
    }
}

#[test]
fn the_first_box_has_what_a_designer_signs() {
    let page = with_page(&of_kernel("four-struts"), None, |page| page.html());
    let first = page.split("id=\"overview\"").nth(1).unwrap().split("</section>").next().unwrap();
    for text in [
        "<dt>verdict</dt><dd>certified</dd>",
        "<dt>nearest limit</dt><dd>",
        "<dt>lengths in</dt><dd>mm</dd>",
        "Every translational machine of four struts within one tolerance",
        "the box [-60, 60] \u{d7} [-60, 60] \u{d7} [150, 220]",
        "<td>joint coordinates: \u{3c1}\u{1d62}</td><td class=\"place\">at most 340 mm</td>",
        "<td>joint speed, tool = 100</td><td class=\"place\">at most",
    ] {
        assert!(first.contains(text), "{text}: {first}");
    }
    assert!(!first.contains("(violated)"));
    let page = with_page(&of_kernel("four-struts-refuted"), None, |page| page.html());
    assert!(page.contains("(violated)") && page.contains("<h2>Counterexample</h2>"));
    assert!(page.contains("<td>greatest \u{3c8} \u{2264} 0.8</td>"));
    assert!(page.contains("<td>(60, 60, 220)</td>") && page.contains("<td>200.05</td>"));
    // The refuted value is worse than the bound, and is where the certificate says.
    let value = page.split("value there</th><td>greatest \u{3c8} \u{2265} ").nth(1).unwrap();
    let value: f64 = value.split('<').next().unwrap().parse().unwrap();
    assert!(value > 0.8 && value < 1.25, "{value}");
}
