use crate::fuzz::Rng;
use crate::known::claim;
use crate::machines::*;
use crate::prover::certify;
use orthocert_kernel::certificate::*;
use orthocert_kernel::check::check;
use orthocert_kernel::problem::Problem;
use serde_json::Value;

fn numbers(v: &mut Value, f: &mut dyn FnMut(&mut Value)) {
    match v { Value::Number(_) => f(v), Value::Array(a) => { if a.len()==2 && a[0].is_u64() && (a[1].is_string()||a[1].is_object()) { f(v); if let Value::Array(a)=v { numbers(&mut a[1], f) } } else { for x in a { numbers(x,f) } } }, Value::Object(o) => for (_,x) in o.iter_mut() { numbers(x,f) }, _=>{} }
}

#[test]
fn mutations() {
    let mut r = Rng(1234577);
    let (mut tried, mut accepted, mut falsely, mut base, mut mutated_accepted) = (0u64,0u64,0u64,0u64,0u64);
    let start = std::time::Instant::now();
    while start.elapsed().as_secs() < 110 {
        let arms = r.below(2)==0;
        let n = 3 + usize::from(r.below(4)==0);
        let legs = machine(&mut r, arms, n);
        let mut c = None;
        for _ in 0..200 { let p=[q(r.range(-4.0,4.0)),q(r.range(-4.0,4.0)),q(r.range(-4.0,4.0))]; if sv(&legs,p).is_some_and(|s| s[0]>1e-2) {c=Some(p);break} }
        let Some(c) = c else { continue };
        let h = q(r.range(0.02,0.5)*0.4).max(1.0/64.0);
        let round = r.below(2)==0;
        let kind = r.below(4);
        let truth = |legs: &[L], h: f64, kind: usize, r: &mut Rng| -> Option<f64> {
            // worst value, so oriented that bound >= worst is true
            let mut worst = f64::MIN;
            for i in 0..216+200 {
                let t: [f64;3] = if i<216 {[i%6,i/6%6,i/36].map(|x| x as f64/5.0)} else {[r.unit(),r.unit(),r.unit()]};
                let p: [f64;3] = std::array::from_fn(|k| c[k]-h+2.0*h*t[k]);
                if round && (p[0]-c[0]).powi(2)+(p[1]-c[1]).powi(2) > h*h { continue }
                let s = sv(legs,p)?;
                worst = worst.max(match kind { 0 => 1.0/s[0], 1 => s[1], 2 => s[1]/s[0], _ => dot(legs[0].row(p)?,legs[0].row(p)?).sqrt() });
            }
            Some(worst)
        };
        let Some(w) = truth(&legs,h,kind,&mut r) else { continue };
        let require = |b: f64| match kind {
            0 => format!(r#"{{"quantity":"transmission","end":"max","bound":"{}"}}"#, num(b)),
            1 => format!(r#"{{"quantity":"transmission","end":"min","bound":"{}"}}"#, num(1.0/b)),
            2 => format!(r#"{{"quantity":"conditioning","end":"max","bound":"{}"}}"#, num(b)),
            _ => format!(r#"{{"quantity":"joint_speed","leg":1,"tool":"1","end":"max","bound":"{}"}}"#, num(b*if arms {180.0/std::f64::consts::PI} else {1.0})),
        };
        let build = |legs: &[L], h: f64, b: f64| {
            let (lo,hi) = (c.map(|x| x-h), c.map(|x| x+h));
            let v = |x: [f64;3]| format!(r#"["{}","{}","{}"]"#, num(x[0]),num(x[1]),num(x[2]));
            let ws = if round { format!(r#"{{"cylinder":{{"center":["{}","{}"],"radius":"{}","z":["{}","{}"]}}}}"#, num(c[0]),num(c[1]),num(h),num(lo[2]),num(hi[2])) } else { format!(r#"{{"box":{{"min":{},"max":{}}}}}"#, v(lo),v(hi)) };
            text(legs,&ws,&require(b))
        };
        let b = w*[1.002,1.02,1.2][r.below(3)];
        if !(b>1e-6 && b<1e6) { continue }
        let t = build(&legs,h,b);
        let cl = claim(&t);
        if Problem::new(&cl).is_err() { continue }
        let Some(cert) = certify(&cl, 1500) else { continue };
        if check(&cert).is_err() { continue }
        base += 1;
        let value = serde_json::to_value(&cert.proof).unwrap();
        for _ in 0..400 {
            let (mut l2,mut h2,mut b2) = (legs.clone(),h,b);
            let mut v2 = value.clone();
            let what = r.below(6);
            if what < 3 { match what { 0 => b2 = b*r.range(0.7,1.05), 1 => h2 = (h*r.range(0.8,1.6)*4096.0).round()/4096.0, _ => { let i=r.below(l2.len()); perturb(&mut l2[i],&mut r) } } }
            if what >= 2 || r.below(3)==0 {
                for _ in 0..1+r.below(3) {
                    let mut count=0; numbers(&mut v2,&mut |_| count+=1);
                    if count==0 {break}
                    let pick=r.below(count); let mut at=0;
                    let (a,bb,k)=(r.next(),r.below(7),r.below(6));
                    numbers(&mut v2,&mut |x| { if at==pick { match x {
                        Value::Number(n) => { let n=n.as_i64().unwrap_or(1); *x=Value::from(match bb {0=>0,1=>n.wrapping_neg(),2=>n.wrapping_mul(2),3=>n+1,4=>(a as i64)<<8,5=>n/2,_=>n+(n as f64*0.05) as i64}) }
                        Value::Array(s) => { let old=s[1].clone(); s[1]=match k {0=>"outside".into(),1=>"test".into(),2=>"divided".into(),3=>serde_json::json!({"inside":[old,a%100000,16]}),4=> { if let Some(y)=old.get("lower") {serde_json::json!({"lower_divided":y})} else if let Some(y)=old.get("lower_divided") {serde_json::json!({"lower":y})} else {"negative".into()} },_=>{ if let Some(y)=old.get("inside") { y[0].clone() } else {"cube".into()} }} }
                        _=>{} } } at+=1; });
                }
            }
            let Ok(proof) = serde_json::from_value::<Proof>(v2) else { continue };
            let cl2 = claim(&build(&l2,h2,b2));
            let cert2 = Certificate { format: FORMAT.into(), claim: Claim::Machine(cl2), verdict: Verdict::Certified, proof, provenance: Provenance { tool: "t".into(), version: "0".into() } };
            tried += 1;
            if check(&cert2).is_ok() {
                accepted += 1; if what != 0 { mutated_accepted += 1 }
                let w2 = truth(&l2,h2,kind,&mut r);
                if w2.is_none_or(|w2| w2 > b2*(1.0+1e-6)) { falsely += 1; println!("FALSE kind {kind} what {what} {w2:?} {b2}: {}", cert2.to_text().unwrap()) }
            }
        }
    }
    println!("mutations: {base} certificates, {tried} mutants, {accepted} accepted ({mutated_accepted} beyond the bound), {falsely} falsely");
}

fn perturb(l: &mut L, r: &mut Rng) {
    let f = 1.0+r.range(-0.1,0.1);
    let k0 = r.below(3);
    match l { L::Slider{n,a,l,..} => { if r.below(2)==0 {*l=(*l*f*4096.0).round()/4096.0} else {a[k0]+=q(f-1.0); n[k0]+=q(f-1.0)} }
        L::Strut{a,..} => a[k0]+=q((f-1.0)*3.0), L::Arm{a,r:rr,..} => { a[k0]+=q(f-1.0); *rr=(*rr*f*4096.0).round()/4096.0 }, L::Planar{n} => n[k0]+=q(f-1.0) }
}

/// Users' own formulas against plain evaluation.
#[test]
fn formulas() {
    let mut r = Rng(5550123);
    let (mut tried, mut accepted, mut falsely, mut degenerate) = (0,0,0,0);
    let start = std::time::Instant::now();
    while start.elapsed().as_secs() < 60 {
        let m = 1 + r.below(2);
        let names = ["x","y"];
        let rho: Vec<E> = (0..m+r.below(2)).map(|_| expression(&mut r, m, 3)).collect();
        let lo: Vec<f64> = (0..m).map(|_| q(r.range(-2.0,2.0))).collect();
        let hi: Vec<f64> = lo.iter().map(|x| x+q(r.range(0.02,1.0)).max(1.0/64.0)).collect();
        let j: Vec<String> = rho.iter().map(|e| format!(r#"{{"rho":"{}"}}"#, e.text(0))).collect();
        let qq = |v: &[f64]| v.iter().map(|x| format!("\"{}\"", num(*x))).collect::<Vec<_>>().join(",");
        let cs: Vec<String> = names[..m].iter().map(|n| format!("\"{n}\"")).collect();
        let t = format!(r#"{{"mechanism":{{"formulas":{{"coordinates":[{}],"parameters":[],"definitions":[],"joints":[{}]}}}},"workspace":{{"box":{{"min":[{}],"max":[{}]}}}},"require":[]}}"#, cs.join(","), j.join(","), qq(&lo), qq(&hi));
        let Ok(cl) = serde_json::from_str(&t) else { continue };
        if Problem::new(&cl).is_err() { continue }
        tried += 1;
        let Some(cert) = certify(&cl, 60) else { continue };
        if check(&cert).is_err() { continue }
        accepted += 1;
        let mut bad = None;
        for i in 0..200 {
            let p: Vec<f64> = (0..m).map(|k| lo[k]+(hi[k]-lo[k])*if i<9 { [0.0,0.5,1.0][(i/[1,3][k])%3] } else {r.unit()}).collect();
            let mut rows = Vec::new();
            for e in &rho { let Some(_) = e.at(&p) else { bad=Some("undefined"); break };
                let g: Vec<f64> = (0..m).map(|k| { let mut a=p.clone(); a[k]+=1e-6; let mut b=p.clone(); b[k]-=1e-6; (e.at(&a).unwrap_or(f64::NAN)-e.at(&b).unwrap_or(f64::NAN))/2e-6 }).collect(); rows.push(g) }
            if bad.is_some() {break}
            if rows.iter().flatten().any(|x| !x.is_finite()) { continue }
            let s = nalgebra::DMatrix::from_fn(rows.len(),m,|i,k| rows[i][k]).singular_values().min();
            if s < 1e-9 { bad=Some("singular"); break }
        }
        if let Some(why) = bad { falsely += 1; if falsely < 12 { println!("FALSE {why}: {t}") } else { degenerate += 1 } }
    }
    println!("formulas: {tried} tried, {accepted} accepted, {falsely} falsely ({degenerate} not printed)");
}

enum E { X(usize), N(i64), B(char,Box<E>,Box<E>), S(Box<E>), P(Box<E>,u32) }
impl E {
    fn at(&self, p: &[f64]) -> Option<f64> { Some(match self { E::X(k)=>p[*k], E::N(n)=>*n as f64, E::B(o,a,b)=>{ let (a,b)=(a.at(p)?,b.at(p)?); match o {'+'=>a+b,'-'=>a-b,'*'=>a*b,_=>{ if b==0.0 {return None} a/b }} }, E::S(a)=>{let a=a.at(p)?; if a<0.0 {return None} a.sqrt()}, E::P(a,n)=>a.at(p)?.powi(*n as i32) }) }
    fn text(&self, enough: u8) -> String { let (t,s)=match self { E::X(k)=>(["x","y"][*k].to_owned(),5), E::N(n)=>(n.to_string(),5), E::S(a)=>(format!("sqrt({})",a.text(0)),5), E::P(a,n)=>(format!("{}^{n}",a.text(5)),4),
        E::B(o,a,b)=>{ let s=if "+-".contains(*o) {1} else {2}; (format!("{}{o}{}",a.text(s),b.text(s+1)),s) } }; if s>=enough {t} else {format!("({t})")} }
}
fn expression(r: &mut Rng, m: usize, depth: usize) -> E {
    if depth==0 || r.below(8)==0 { return if r.below(4)==0 {E::N(r.below(4) as i64)} else {E::X(r.below(m))} }
    match r.below(9) { 0 => E::S(Box::new(expression(r,m,depth-1))), 1 => E::P(Box::new(expression(r,m,depth-1)), 2+r.below(3) as u32),
        k => E::B(['+','-','*','/','+','-','*'][k-2], Box::new(expression(r,m,depth-1)), Box::new(expression(r,m,depth-1))) }
}
