use crate::prover::certify;
use orthocert_kernel::certificate::*;
use orthocert_kernel::check::check;
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::problem::Problem;

pub fn claim(text: &str) -> MachineClaim { serde_json::from_str(text).unwrap_or_else(|e| panic!("{e}: {text}")) }

fn both(name: &str, text: &str, witness: &str) {
    let c = claim(text);
    let problem = match Problem::new(&c) { Ok(p) => p, Err(e) => { println!("{name}: claim refused {e}"); return } };
    let cert = certify(&c, 2000);
    let yes = match &cert { None => "no proof".to_owned(), Some(c) => {
        let t = c.to_text().unwrap();
        let r = Certificate::read(&t).unwrap();
        format!("{:?} {}", check(&r), if check(&r).is_ok() { t } else { String::new() }) } };
    let no = if witness.is_empty() { "-".into() } else {
        let w: Witness = serde_json::from_str(witness).unwrap();
        let cert = Certificate { format: FORMAT.into(), claim: Claim::Machine(c.clone()), verdict: Verdict::Refuted, proof: Proof::Witness(w), provenance: Provenance { tool: "t".into(), version: "0".into() } };
        let t = cert.to_text().unwrap();
        let r = Certificate::read(&t).unwrap();
        format!("{:?}", check(&r)) };
    println!("{name}: tape {} | certified: {yes} | refuted: {no}\n", problem.tape.ops().len());
}

fn formulas(defs: &str, joints: &str) -> String {
    format!(r#"{{"mechanism":{{"formulas":{{"coordinates":["x"],"parameters":[],"definitions":[{defs}],"joints":[{joints}]}}}},"workspace":{{"box":{{"min":["0"],"max":["1"]}}}},"require":[]}}"#)
}

#[test]
fn cube() {
    both("cube psi_min 1.9", r#"{"mechanism":{"orthoglide":{"offset":"0"}},"workspace":{"cube":{"side":"200"}},
        "require":[{"quantity":"transmission","end":"min","bound":"1.9"},{"quantity":"transmission","end":"max","bound":"2"}]}"#,
        r#"{"precision":100,"point":["0","0","0"],"fails":{"obligation":[1,[[1,0,0]]]}}"#);
    both("cube psi_min 100", r#"{"mechanism":{"orthoglide":{"offset":"0"}},"workspace":{"cube":{"side":"200"}},
        "require":[{"quantity":"transmission","end":"min","bound":"100"},{"quantity":"transmission","end":"max","bound":"2"}]}"#,
        r#"{"precision":100,"point":["0","0","0"],"fails":{"obligation":[1,[[1,0,0]]]}}"#);
}

#[test]
fn defined() {
    let w = r#"{"precision":100,"point":["0"],"fails":"reach"}"#;
    both("rho = x+sqrt(x-x-1)", &formulas("", r#"{"rho":"x+sqrt(x-x-1)"}"#), w);
    both("rho = x+1/(x-x)", &formulas("", r#"{"rho":"x+1/(x-x)"}"#), w);
    both("unused definition", &formulas(r#"["u","sqrt(x-5)"]"#, r#"{"rho":"x"}"#), w);
    both("0*sqrt", &formulas("", r#"{"rho":"x+0*sqrt(x-5)"}"#), w);
    both("0*sqrt row", &formulas("", r#"{"row":["1+0*sqrt(x-5)"]}"#), w);
    both("0/x row", &formulas("", r#"{"row":["1+0/(x-1/2)"]}"#), w);
    both("0*(1/x) row", &formulas("", r#"{"row":["1+0*(1/(x-1/2))"]}"#), w);
    both("two negatives", &formulas("", r#"{"rho":"sqrt(x-10)/sqrt(x-x-1)"}"#), w);
    both("x/0", &formulas("", r#"{"rho":"x/0"}"#), w);
    both("root of a tiny negative", &formulas("", &format!(r#"{{"rho":"x+sqrt(-0.{}1)"}}"#, "0".repeat(700))), w);
    both("root of a tiny negative, parameter", &formulas("", r#"{"rho":"x"}"#).replace(r#""parameters":[]"#, &format!(r#""parameters":[["q","sqrt(-0.{}1)"]]"#, "0".repeat(700))), w);
    both("tool", &formulas("", r#"{"rho":"x"}"#).replace(r#""require":[]"#, r#""require":[{"quantity":"transmission","tool":"sqrt(-1)","end":"max","bound":"2"}]"#), "");
    both("sqrt(x^2) at 0", &formulas("", r#"{"row":["1+sqrt(x)"]}"#), w);
}

fn hexapod(n: usize, names: &[&str]) -> String {
    let q: Vec<String> = names.iter().map(|n| format!("\"{n}\"")).collect();
    let rho: Vec<String> = (0..n).map(|i| {
        let inner: Vec<String> = names.iter().enumerate().map(|(k, n)| format!("({n}-{})^2", (i * 7 + k * 3) % 11 + 10)).collect();
        format!(r#"{{"rho":"sqrt({})"}}"#, inner.join("+"))
    }).collect();
    let lo: Vec<&str> = names.iter().map(|_| "\"0\"").collect();
    let hi: Vec<&str> = names.iter().map(|_| "\"1\"").collect();
    format!(r#"{{"mechanism":{{"formulas":{{"coordinates":[{}],"parameters":[],"definitions":[],"joints":[{}]}}}},"workspace":{{"box":{{"min":[{}],"max":[{}]}}}},"require":[]}}"#,
        q.join(","), rho.join(","), lo.join(","), hi.join(","))
}

#[test]
fn gradients_of_gradients() {
    for (n, names) in [(3, &["x", "y", "z"][..]), (4, &["x", "y", "z"]), (5, &["x", "y", "z"]), (2, &["x", "y"]), (4, &["x", "y"]), (6, &["x"]), (3, &["x", "y", "z"]), ] {
        let c = claim(&hexapod(n, names));
        let t = std::time::Instant::now();
        let p = Problem::new(&c).map(|p| p.tape.ops().len());
        println!("joints {n} coordinates {}: tape {p:?} {:?}", names.len(), t.elapsed());
    }
}

#[test]
fn powers() {
    for depth in 2..=3 {
        let mut e = "l".to_owned();
        for _ in 0..depth { e = format!("({e})^64"); }
        let e = e.replace("(l)", "l");
        let text = formulas("", &format!(r#"{{"rho":"x+{e}"}}"#)).replace(r#""parameters":[]"#, r#""parameters":[["l","3"]]"#);
        let c = claim(&text);
        let t = std::time::Instant::now();
        let ok = Problem::new(&c).is_ok();
        println!("power depth {depth}: {} bytes of claim, ok {ok} {:?}", text.len(), t.elapsed());
    }
}

#[test]
fn rationals() {
    // 8 KB: a long literal, then many quotients.
    let mut e = format!("1.{}1", "7".repeat(4000));
    let mut k = 3;
    while e.len() < 8150 { e += &format!("/{k}*7"); k += 2; if k > 1500 { break } if e.matches(['/', '*']).count() > 505 { break } }
    let text = formulas("", r#"{"rho":"x"}"#).replace(r#""parameters":[]"#, &format!(r#""parameters":[["q","{e}"]]"#));
    let c = claim(&text);
    let t = std::time::Instant::now();
    let ok = Problem::new(&c).map(|_| ());
    println!("rational: {} bytes, {ok:?} {:?}", text.len(), t.elapsed());
}
