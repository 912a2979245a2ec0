use crate::known::claim;
use orthocert_kernel::certificate::*;
use orthocert_kernel::check::check;
use orthocert_kernel::problem::Problem;

fn rss() -> String { std::fs::read_to_string("/proc/self/status").unwrap().lines().filter(|l| l.starts_with("VmHWM")).collect() }

/// One node, a claim with many operations per byte.
#[test]
#[ignore]
fn wide() {
    let n: usize = std::env::var("N").unwrap().parse().unwrap();
    let precision: u32 = std::env::var("P").unwrap().parse().unwrap();
    let mut defs = vec![r#"["d0","x-y+z"]"#.to_owned()];
    for k in 1..n { defs.push(format!(r#"["d{k}","d{}^63"]"#, k - 1)); }
    let t = format!(r#"{{"mechanism":{{"formulas":{{"coordinates":["x","y","z","u","v","w"],"parameters":[],"definitions":[{}],"joints":[{}]}}}},"workspace":{{"box":{{"min":["0.1","0.1","0.1","0.1","0.1","0.1"],"max":["0.2","0.2","0.2","0.2","0.2","0.2"]}}}},"require":[]}}"#, defs.join(","),
        ["x","y","z","u","v","w"].map(|x| format!(r#"{{"row":[{}]}}"#, ["x","y","z","u","v","w"].map(|y| if x==y {"\"1\""} else {"\"0\""}).join(","))).join(","));
    let unit: Vec<Vec<i64>> = (0..6).map(|i| (0..6).map(|k| i64::from(i == k)).collect()).collect();
    let node = Node { by: vec![Step(0, Evidence::Lower(orthocert_kernel::test::Multiplier { y: unit, places: 0 }))], split: None };
    let c = Certificate { format: FORMAT.into(), claim: Claim::Machine(claim(&t)), verdict: Verdict::Certified,
        proof: Proof::Tree(Tree { precision, nodes: vec![node] }), provenance: Provenance { tool: "t".into(), version: "0".into() } };
    let text = c.to_text().unwrap();
    let s = std::time::Instant::now();
    let c = Certificate::read(&text).unwrap();
    let Claim::Machine(m) = &c.claim;
    println!("{} bytes, tape {}", text.len(), Problem::new(m).unwrap().tape.ops().len());
    println!("{:?} {:?} {}", check(&c), s.elapsed(), rss());
}

#[test]
#[ignore]
fn power() {
    let depth: usize = std::env::var("N").unwrap().parse().unwrap();
    let mut e = "l".to_owned();
    for k in 0..depth { e = if k == 0 { format!("{e}^64") } else { format!("({e})^64") }; }
    let t = format!(r#"{{"mechanism":{{"formulas":{{"coordinates":["x"],"parameters":[["l","3"]],"definitions":[],"joints":[{{"rho":"x+{e}"}}]}}}},"workspace":{{"box":{{"min":["0"],"max":["1"]}}}},"require":[]}}"#);
    let s = std::time::Instant::now();
    println!("{} bytes: ok {} {:?} {}", t.len(), Problem::new(&claim(&t)).is_ok(), s.elapsed(), rss());
}

#[test]
#[ignore]
fn joints() {
    let n: usize = std::env::var("N").unwrap().parse().unwrap();
    let names = ["x","y","z","u","v","w"];
    let rho: Vec<String> = (0..n).map(|i| { let inner: Vec<String> = names.iter().enumerate().map(|(k,n)| format!("({n}-{})^2",(i*7+k*3)%11+10)).collect(); format!(r#"{{"rho":"sqrt({})"}}"#, inner.join("+")) }).collect();
    let t = format!(r#"{{"mechanism":{{"formulas":{{"coordinates":["x","y","z","u","v","w"],"parameters":[],"definitions":[],"joints":[{}]}}}},"workspace":{{"box":{{"min":["0","0","0","0","0","0"],"max":["1","1","1","1","1","1"]}}}},"require":[]}}"#, rho.join(","));
    let s = std::time::Instant::now();
    println!("{} bytes, {n} joints: {:?} {:?} {}", t.len(), Problem::new(&claim(&t)).map(|p| p.tape.ops().len()), s.elapsed(), rss());
}

/// A hard step: sign vertices, twelve legs, conditioning.
#[test]
#[ignore]
fn legs() {
    let n: usize = std::env::var("N").unwrap().parse().unwrap();
    let t = format!(r#"{{"mechanism":{{"translational":[{}]}},"workspace":{{"box":{{"min":["0","0","0"],"max":["1","1","1"]}}}},"require":[]}}"#,
        vec![r#"{"drive":"strut","anchor":["7","8","9"],"platform":["0","0","0"]}"#; n].join(","));
    let s = std::time::Instant::now();
    println!("{} bytes, {n} legs: {:?} {:?} {}", t.len(), Problem::new(&claim(&t)).map(|p| p.tape.ops().len()), s.elapsed(), rss());
}

#[test]
#[ignore]
fn memory() {
    for unit in ["{},", "{\"by\":[[0,{\"lower\":{\"y\":[[],[],[],[],[],[],[],[],[],[],[],[]],\"places\":0}}]]},"] {
        let head = r#"{"format":"orthocert/2","claim":{"machine":{"mechanism":{"formulas":{"coordinates":["x"],"parameters":[],"definitions":[],"joints":[{"rho":"x"}]}},"workspace":{"box":{"min":["0"],"max":["1"]}},"require":[]}},"verdict":"certified","proof":{"tree":{"precision":52,"nodes":["#;
        let tail = "{}]}},\"provenance\":{\"tool\":\"t\",\"version\":\"0\"}}\n";
        let t = format!("{head}{}{tail}", unit.repeat(((16 << 20) - head.len() - tail.len()) / unit.len()));
        let s = std::time::Instant::now();
        let c = Certificate::read(&t);
        println!("{} bytes {unit}: {:?} {:?} {}", t.len(), c.map(|c| check(&c)).map_err(|_| "unreadable"), s.elapsed(), rss());
    }
}

#[test]
#[ignore]
fn nodes() {
    let n: usize = std::env::var("N").unwrap().parse().unwrap();
    let mut defs = vec![r#"["d0","x+1/8"]"#.to_owned()];
    for k in 1..n { defs.push(format!(r#"["d{k}","d{}*x+1/8"]"#, k - 1)); }
    let t = format!(r#"{{"mechanism":{{"formulas":{{"coordinates":["x"],"parameters":[],"definitions":[{}],"joints":[{{"rho":"x"}}]}}}},"workspace":{{"box":{{"min":["0.1"],"max":["0.2"]}}}},"require":[]}}"#, defs.join(","));
    let leaf = || Node { by: vec![Step(0, Evidence::Lower(orthocert_kernel::test::Multiplier { y: vec![vec![1]], places: 1 }))], split: None };
    let mut tree = vec![leaf()];
    for _ in 0..6 { let half = tree.clone(); tree = std::iter::once(Node { by: vec![], split: Some(0) }).chain(half.clone()).chain(half).collect(); }
    for precision in [52, 1024] {
        let c = Certificate { format: FORMAT.into(), claim: Claim::Machine(claim(&t)), verdict: Verdict::Certified, proof: Proof::Tree(Tree { precision, nodes: tree.clone() }), provenance: Provenance { tool: "t".into(), version: "0".into() } };
        let s = std::time::Instant::now();
        let ok = check(&c);
        println!("precision {precision}: claim {} bytes, 64 leaves {} bytes: {ok:?} {:?} {}", t.len(), serde_json::to_string(&c.proof).unwrap().len(), s.elapsed(), rss());
    }
}
