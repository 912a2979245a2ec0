use crate::fuzz::Rng;
use crate::known::claim;
use crate::machines::*;
use crate::prover::certify;
use orthocert_kernel::certificate::*;
use orthocert_kernel::check::check;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::test::Multiplier;

#[test]
fn hostile_text() {
    let good = certify(&claim(r#"{"mechanism":{"formulas":{"coordinates":["x"],"parameters":[["l",{"min":"1","max":"2"}]],"definitions":[],"joints":[{"rho":"x"}]}},"workspace":{"box":{"min":["0"],"max":["1"]}},"require":[{"quantity":"joint_range","leg":1,"end":"min","bound":"-1"}]}"#), 10).unwrap().to_text().unwrap();
    assert!(Certificate::read(&good).is_ok());
    let swaps = [("\"format\":\"orthocert/2\",", "\"format\":\"orthocert/2\",\"format\":\"orthocert/2\","), ("\"min\":\"1\",\"max\":\"2\"", "\"max\":\"2\",\"min\":\"1\""), ("\"min\":\"1\",\"max\":\"2\"", "\"min\":\"1\",\"max\":\"2\",\"q\":3"),
        ("\"min\":\"1\",\"max\":\"2\"", "\"min\":\"1\",\"min\":\"1\",\"max\":\"2\""), ("\"leg\":1", "\"leg\":1.0"), ("\"leg\":1", "\"leg\":1e0"), ("\"leg\":1,", "\"leg\":1,\"zzz\":0,"), ("\"leg\":1,", "\"leg\":1,\"leg\":1,"), ("\"leg\":1,", "\"leg\":null,"), ("\"leg\":1", "\"leg\":-0"),
        ("\"leg\":1", "\"leg\":99999999999999999999999"), ("\"rho\"", "\"\\u0072ho\""), ("\"-1\"", "\"\\u002d1\""), ("\"-1\"", "\"-1.0\""), ("\"-1\"", "\"-01\""), ("\"-1\"", "\"(-1)\""), ("\"-1\"", "\" -1\""), ("\"test\"", "{\"test\":null}"), ("\"places\":14", "\"places\":-1"), ("\"places\":14", "\"places\":4294967296"),
        ("\"end\":\"min\",\"bound\":\"-1\"", "\"bound\":\"-1\",\"end\":\"min\""), ("\"version\":\"0\"", "\"version\":\"0\",\"x\":1"), ("}\n", "}"), ("}\n", "}\n\n"), ("\"require\"", "\"requirE\"")];
    let mut refused = 0;
    for (a, b) in swaps { assert!(good.contains(a) || a.contains("places") , "{a} {good}"); if !good.contains(a) { continue } let t = good.replacen(a, b, 1); assert!(Certificate::read(&t).is_err(), "{t}"); refused += 1; }
    for deep in ["[", "{\"inside\":[", "{\"a\":"] { for whole in [false, true] {
        let many = deep.repeat(1_000_000);
        let t = if whole { good.replacen("\"by\":[[0,", &format!("\"by\":[[0,{many}"), 1) } else { many };
        assert!(Certificate::read(&t).is_err()); refused += 1; } }
    // every single byte changed
    let mut accepted = 0; let mut r = Rng(99); let mut other = 0;
    for _ in 0..30000 { let mut b = good.clone().into_bytes(); let i = r.below(b.len()); b[i] = (r.next() % 96 + 32) as u8; if r.below(3) == 0 { b.remove(i); } let t = String::from_utf8(b).unwrap(); if t == good { continue }
        if let Ok(c) = Certificate::read(&t) { other += 1; if check(&c).is_ok() { accepted += 1; assert_ne!(c.to_text().unwrap(), good) } } }
    println!("text: {refused} refused; {other} readable changes, {accepted} accepted");
    for names in [r#"[""]"#, r#"["sqrt"]"#, r#"["1"]"#, r#"["x y"]"#, "[\"\u{445}\"]"] {
        let c = claim(&format!(r#"{{"mechanism":{{"formulas":{{"coordinates":{names},"parameters":[],"definitions":[],"joints":[{{"rho":"1"}}]}}}},"workspace":{{"box":{{"min":["0"],"max":["1"]}}}},"require":[]}}"#));
        println!("coordinate {names}: {:?}", Problem::new(&c).map(|_| ()));
    }
    for (what, t) in [("zero direction", r#"{"drive":"slider","direction":[{"min":"-1","max":"1"},"0","0"],"anchor":["0","0","0"],"platform":["0","0","0"],"length":"3","mode":"+"}"#),
        ("parallel reference", r#"{"drive":"arm","axis":["1","0","0"],"reference":["2","0","0"],"anchor":["0","0","0"],"platform":["0","0","0"],"arm":"1","length":"3","mode":"+"}"#),
        ("swapped", r#"{"drive":"strut","anchor":[{"min":"1","max":"-1"},"0","0"],"platform":["0","0","0"]}"#),
        ("equal", r#"{"drive":"strut","anchor":[{"min":"1","max":"1"},"0","0"],"platform":["0","0","0"]}"#),
        ("length about 0", r#"{"drive":"slider","direction":["1","0","0"],"anchor":["0","0","0"],"platform":["0","0","0"],"length":{"min":"-1","max":"3"},"mode":"+"}"#),
        ("name", r#"{"drive":"strut","anchor":["x","0","0"],"platform":["0","0","0"]}"#), ("huge", r#"{"drive":"strut","anchor":["10^64^2","0","0"],"platform":["0","0","0"]}"#)] {
        let r = serde_json::from_str(&format!(r#"{{"mechanism":{{"translational":[{t},{t},{t}]}},"workspace":{{"box":{{"min":["0","0","0"],"max":["1","1","1"]}}}},"require":[]}}"#)).map(|c| Problem::new(&c).map(|_| ()));
        println!("{what}: {r:?}");
    }
    for ws in [r#"{"box":{"min":["1","0","0"],"max":["0","1","1"]}}"#, r#"{"box":{"min":[],"max":[]}}"#, r#"{"cylinder":{"center":["0","0"],"radius":"0","z":["0","1"]}}"#, r#"{"cylinder":{"center":["0","0"],"radius":"1","z":["1","0"]}}"#, r#"{"cube":{"side":"1"}}"#] {
        let t = r#"{"drive":"strut","anchor":["9","8","7"],"platform":["0","0","0"]}"#;
        println!("{ws}: {:?}", Problem::new(&claim(&format!(r#"{{"mechanism":{{"translational":[{t},{t},{t}]}},"workspace":{ws},"require":[]}}"#))).map(|_| ()));
    }
    println!("angles {:?}", ["30", "209", "210", "29", "400"].map(|b| { let t = r#"{"drive":"arm","axis":["1","0","0"],"reference":["0","1","0"],"anchor":["0","0","0"],"platform":["0","0","0"],"arm":"1","length":"3","mode":"+"}"#;
        Problem::new(&claim(&format!(r#"{{"mechanism":{{"translational":[{t},{t},{t}]}},"workspace":{{"box":{{"min":["0","0","0"],"max":["1","1","1"]}}}},"require":[{{"quantity":"joint_range","end":"within","bound":["30","{b}"]}}]}}"#))).map(|_| ()).is_ok() }));
}

/// Conditioning with twelve legs and six coordinates at 1024 bits.
#[test]
fn slowest_step() {
    let names = ["x","y","z","u","v","w"];
    let rows: Vec<String> = (0..12).map(|i| format!(r#"{{"row":[{}]}}"#, (0..6).map(|k| format!("\"{}\"", if i % 6 == k { format!("1+{}/8", names[k]) } else { format!("{}/40", names[(i + k) % 6]) })).collect::<Vec<_>>().join(","))).collect();
    let q: Vec<String> = names.iter().map(|n| format!("\"{n}\"")).collect();
    let t = format!(r#"{{"mechanism":{{"formulas":{{"coordinates":[{}],"parameters":[],"definitions":[],"joints":[{}]}}}},"workspace":{{"box":{{"min":["0","0","0","0","0","0"],"max":["{W}","{W}","{W}","{W}","{W}","{W}"]}}}},"require":[{{"quantity":"conditioning","end":"max","bound":"100"}}]}}"#, q.join(","), rows.join(","), W = std::env::var("W").unwrap_or("1".into()));
    let y: Vec<Vec<i64>> = (0..12).map(|i| (0..6).map(|k| i64::from(i % 6 == k) * 8).collect()).collect();
    let m = Multiplier { y, places: 4 };
    let node = Node { by: vec![Step(0, Evidence::Lower(m.clone())), Step(1, Evidence::Conditioning(m, vec![4, 0, 0, 0, 0, 0, 0]))], split: None };
    let c = Certificate { format: FORMAT.into(), claim: Claim::Machine(claim(&t)), verdict: Verdict::Certified, proof: Proof::Tree(Tree { precision: 1024, nodes: vec![node] }), provenance: Provenance { tool: "t".into(), version: "0".into() } };
    let s = std::time::Instant::now();
    println!("slowest step: {:?} {:?}, {} bytes", check(&c), s.elapsed(), c.to_text().unwrap().len());
}

/// Tolerances, kappa = 0, and precisions.
#[test]
fn tolerances() {
    let mut r = Rng(31415926535);
    let (mut tried, mut accepted, mut falsely) = (0, 0, 0);
    let start = std::time::Instant::now();
    while start.elapsed().as_secs() < 60 {
        let arms = r.below(2) == 0;
        let legs = machine(&mut r, arms, 3);
        let mut c = None;
        for _ in 0..200 { let p=[q(r.range(-4.0,4.0)),q(r.range(-4.0,4.0)),q(r.range(-4.0,4.0))]; if sv(&legs,p).is_some_and(|s| s[0]>1e-3) {c=Some(p);break} }
        let Some(c) = c else { continue };
        let h = q(r.range(0.02,1.5)*0.4).max(1.0/64.0);
        // a tolerance of the first leg's length, or anchor
        let tol = [1.0/64.0, 1.0/8.0][r.below(2)];
        let (lo, hi) = (c.map(|x| x - h), c.map(|x| x + h));
        let plain = legs[0].text();
        let with = match &legs[0] {
            L::Slider{l,..} | L::Arm{l,..} => { if *l <= tol { continue } plain.replace(&format!(r#""length":"{}""#, num(*l)), &format!(r#""length":{{"min":"{}","max":"{}"}}"#, num(l-tol), num(l+tol))) }
            L::Strut{a,..} => plain.replacen(&format!(r#"["{}","#, num(a[0])), &format!(r#"[{{"min":"{}","max":"{}"}},"#, num(a[0]-tol), num(a[0]+tol)), 1),
            L::Planar{..} => continue };
        let shift = |s: f64| { let mut l = legs.clone(); match &mut l[0] { L::Slider{l,..}|L::Arm{l,..} => *l+=s*tol, L::Strut{a,..} => a[0]+=s*tol, _=>{} } l };
        let (mut worst, mut ok, mut signs) = (0f64, true, [false;2]);
        for s in [-1.0,-0.5,0.0,0.5,1.0] { let l = shift(s); for i in 0..7*7*7 { let t=[i%7,i/7%7,i/49]; let p: [f64;3] = std::array::from_fn(|k| lo[k]+2.0*h*t[k] as f64/6.0);
            match sv(&l,p) { Some(x) => { worst=worst.max(1.0/x[0]); let rows: Vec<[f64;3]>=l.iter().map(|l| l.row(p).unwrap()).collect(); signs[usize::from(dot(rows[0],cross(rows[1],rows[2]))>0.0)]=true; } None => ok=false } } }
        let zero = r.below(2)==0;
        let slack = [0.99,0.999,1.002,1.05][r.below(4)];
        let truth = ok && !(signs[0]&&signs[1]) && (zero || slack>=1.0);
        let req = if zero { String::new() } else { format!(r#"{{"quantity":"transmission","end":"max","bound":"{}"}}"#, num(worst*slack)) };
        let v = |x: [f64;3]| format!(r#"["{}","{}","{}"]"#, num(x[0]),num(x[1]),num(x[2]));
        let t = text(&legs, &format!(r#"{{"box":{{"min":{},"max":{}}}}}"#, v(lo), v(hi)), &req).replacen(&plain, &with, 1);
        let cl = claim(&t);
        let Ok(problem) = Problem::new(&cl) else { continue };
        assert_eq!(problem.tolerances().count(), 1);
        tried += 1;
        let Some(mut cert) = certify(&cl, if truth {1500} else {500}) else { continue };
        if let Proof::Tree(tree) = &mut cert.proof { tree.precision = [32,40,52,59,60,64,200][r.below(7)]; }
        if check(&cert).is_ok() { accepted += 1; if !truth { falsely += 1; println!("FALSE {ok} {signs:?} {slack} {zero} {t}") } }
    }
    println!("tolerances: {tried} tried, {accepted} accepted, {falsely} falsely");
}
