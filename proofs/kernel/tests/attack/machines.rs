use crate::fuzz::Rng;
use crate::known::claim;
use crate::prover::{certify, double};
use num_bigint::BigInt;
use orthocert_kernel::check::check;
use orthocert_kernel::formula::Op;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::machine::Joint;
use orthocert_kernel::fixed::*;

type V = [f64; 3];
pub fn dot(a: V, b: V) -> f64 { a[0]*b[0]+a[1]*b[1]+a[2]*b[2] }
fn sub(a: V, b: V) -> V { [a[0]-b[0], a[1]-b[1], a[2]-b[2]] }
fn add(a: V, b: V) -> V { [a[0]+b[0], a[1]+b[1], a[2]+b[2]] }
fn mul(s: f64, a: V) -> V { [s*a[0], s*a[1], s*a[2]] }
pub fn cross(a: V, b: V) -> V { [a[1]*b[2]-a[2]*b[1], a[2]*b[0]-a[0]*b[2], a[0]*b[1]-a[1]*b[0]] }
fn unit(a: V) -> V { mul(1.0/dot(a,a).sqrt(), a) }

#[derive(Clone, Debug)]
pub enum L { Slider{n:V,a:V,d:V,l:f64,m:f64}, Strut{a:V,d:V}, Arm{k:V,e:V,a:V,d:V,r:f64,l:f64,m:f64}, Planar{n:V} }

impl L {
    /// Joint coordinate and leg vector, from geometry alone.
    pub fn solve(&self, p: V) -> Option<(f64, V, f64)> {
        match *self {
            L::Slider{n,a,d,l,m} => {
                let n = unit(n);
                // |p + d - a - rho n| = l: rho = n.w -+ sqrt((n.w)^2 - (|w|^2 - l^2))
                let w = sub(add(p,d),a); let b = dot(n,w); let disc = b*b - (dot(w,w)-l*l);
                if disc <= 0.0 { return None }
                let rho = b - m*disc.sqrt();
                let leg = sub(w, mul(rho,n));
                Some((rho, leg, dot(leg,n)/l))
            }
            L::Strut{a,d} => { let w = sub(add(p,d),a); let r = dot(w,w).sqrt(); (r>0.0).then_some((r,w,1.0)) }
            L::Arm{k,e,a,d,r,l,m} => {
                let k = unit(k); let e = unit(sub(e, mul(dot(e,k),k))); let f = cross(k,e);
                let w = sub(add(p,d),a);
                let (al,be) = (dot(w,e),dot(w,f)); let big = (al*al+be*be).sqrt();
                let c = (dot(w,w)+r*r-l*l)/(2.0*r*big);
                if c.abs() >= 1.0 { return None }
                for s in [1.0,-1.0] {
                    let th = be.atan2(al)+s*c.acos();
                    let u = add(mul(th.cos(),e),mul(th.sin(),f));
                    let leg = sub(w, mul(r,u));
                    let eta = dot(leg, cross(k,u));
                    if eta*m > 0.0 { return Some((th,leg,eta/l)) }
                }
                None
            }
            L::Planar{n} => { let n = unit(n); Some((dot(n,p),n,1.0)) }
        }
    }
    pub fn row(&self, p: V) -> Option<V> {
        let h = 1e-5;
        let mut g = [0.0;3];
        for k in 0..3 { let mut a=p; let mut b=p; a[k]+=h; b[k]-=h;
            let mut d = self.solve(a)?.0-self.solve(b)?.0;
            if matches!(self, L::Arm{..}) { d = (d + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU) - std::f64::consts::PI }
            g[k]=d/(2.0*h) }
        Some(g)
    }
    pub fn text(&self) -> String {
        let v = |v:&V| format!(r#"["{}","{}","{}"]"#, num(v[0]), num(v[1]), num(v[2]));
        let s = |m:f64| if m>0.0 {"+"} else {"-"};
        match self {
            L::Slider{n,a,d,l,m} => format!(r#"{{"drive":"slider","direction":{},"anchor":{},"platform":{},"length":"{}","mode":"{}"}}"#, v(n),v(a),v(d),num(*l),s(*m)),
            L::Strut{a,d} => format!(r#"{{"drive":"strut","anchor":{},"platform":{}}}"#, v(a),v(d)),
            L::Arm{k,e,a,d,r,l,m} => format!(r#"{{"drive":"arm","axis":{},"reference":{},"anchor":{},"platform":{},"arm":"{}","length":"{}","mode":"{}"}}"#, v(k),v(e),v(a),v(d),num(*r),num(*l),s(*m)),
            L::Planar{n} => format!(r#"{{"drive":"planar","direction":{}}}"#, v(n)),
        }
    }
}
pub fn num(x: f64) -> String { let t = format!("{x:.12}"); let t = t.trim_end_matches('0').trim_end_matches('.'); if t == "-0" { "0".into() } else { t.to_owned() } }
pub fn q(x: f64) -> f64 { (x*64.0).round()/64.0 }

pub fn machine(r: &mut Rng, arms: bool, n: usize) -> Vec<L> {
    let s = 2f64.powi(r.below(9) as i32 - 4);
    (0..n).map(|_| {
        let mut v = |s: f64| -> V { [q(r.range(-s,s)), q(r.range(-s,s)), q(r.range(-s,s))] };
        let (a,d,n,e) = (v(s),v(s/4.0),v(2.0),v(2.0));
        let n = if dot(n,n)<0.3 {[1.0,0.0,0.0]} else {n};
        let e = if dot(cross(n,e),cross(n,e))<0.3 { if n[0].abs() < n[1].abs() {[1.0,0.0,0.0]} else {[0.0,1.0,0.0]} } else {e};
        let m = if r.below(2)==0 {1.0} else {-1.0};
        if arms { L::Arm{k:n,e,a,d,r:q(r.range(0.5,1.5)*s)+0.125,l:q(r.range(1.0,2.5)*s)+0.125,m} }
        else { match r.below(5) { 0|1 => L::Slider{n,a,d,l:q(r.range(1.0,4.0)*s)+0.125,m}, 4 => L::Planar{n}, _ => L::Strut{a,d} } }
    }).collect()
}

pub fn text(legs: &[L], workspace: &str, require: &str) -> String {
    let l: Vec<String> = legs.iter().map(L::text).collect();
    format!(r#"{{"mechanism":{{"translational":[{}]}},"workspace":{workspace},"require":[{require}]}}"#, l.join(","))
}

#[test]
fn formulas_are_the_geometry() {
    let mut r = Rng(424242);
    let (mut rows, mut unreached) = (0, 0);
    for case in 0..3000 {
        let arms = r.below(2)==0;
        let legs = machine(&mut r, arms, 3);
        let c = claim(&text(&legs, r#"{"box":{"min":["0","0","0"],"max":["1","1","1"]}}"#, ""));
        let Ok(problem) = Problem::new(&c) else { panic!("refused") };
        let par = problem.parameters::<BigInt>(200,&[]).unwrap();
        let s = 2f64.powi(problem.scale as i32);
        for _ in 0..5 {
            let p = [q(r.range(-2.0,2.0)*s), q(r.range(-2.0,2.0)*s), q(r.range(-2.0,2.0)*s)];
            let fx = Fixed::<BigInt>::new(200);
            let bi = |x: f64| BigInt::from((x*2f64.powi(40)) as i64) << 160usize;
            let v = problem.tape.run(&fx, |op| match op { Op::Coordinate(k)=>Some(Interval::point(bi(p[k]/s))), Op::Parameter(j)=>Some(par[j].clone()), _=>None });
            for (i,(leg,pl)) in legs.iter().zip(&problem.legs).enumerate() {
                let f = |f| v.of(f).map(|x| { let (a,b)=double(&Interval{lo:&x.lo>>100usize,hi:&x.hi>>100usize},100); (a+b)/2.0 });
                let d = f(pl.row.d);
                let Some((rho,vec,eta)) = leg.solve(p) else { assert!(d.is_none() || d.unwrap() <= 1e-9, "case {case} leg {i}"); unreached+=1; continue };
                if d.is_none() || d.unwrap() < 1e-3 { continue }
                let Some(g) = leg.row(p) else { continue };
                let unitm = if arms { s } else { 1.0 };
                for k in 0..3 {
                    let a = f(pl.row.a[k]).unwrap()/d.unwrap().sqrt();
                    let b = f(pl.divided.a[k]).unwrap();
                    assert!((b-g[k]*unitm).abs()<1e-4*(1.0+b.abs()), "case {case} leg {i} divided {b} {}", g[k]*unitm);
                    assert!((a.abs()-b.abs()).abs()<1e-7*(1.0+b.abs()), "case {case} a {a} {b}");
                    let u = f(pl.row.a[k]).unwrap();
                    let scale = if matches!(leg, L::Planar{..}) {1.0} else {s};
                    assert!((u-vec[k]/scale).abs()<1e-6*(1.0+u.abs()), "leg vector");
                }
                match pl.rho.unwrap() {
                    Joint::Length(x) => assert!((f(x).unwrap()-rho/s).abs()<1e-6, "rho"),
                    Joint::Angle{cos,sin} => assert!((f(cos).unwrap()-rho.cos()).abs()<1e-6 && (f(sin).unwrap()-rho.sin()).abs()<1e-6, "theta"),
                }
                if let Some((e2,l2)) = pl.oblique { assert!((f(e2).unwrap()/f(l2).unwrap()-eta*eta).abs()<1e-6, "oblique") }
                rows+=1;
            }
        }
    }
    println!("geometry: {rows} rows, {unreached} unreached");
}

pub fn sv(legs: &[L], p: V) -> Option<[f64;2]> {
    let rows: Option<Vec<V>> = legs.iter().map(|l| l.row(p)).collect();
    let rows = rows?;
    let m = nalgebra::DMatrix::from_fn(rows.len(),3,|i,k| rows[i][k]);
    let s = m.singular_values();
    Some([s.min(), s.max()])
}

#[test]
pub fn near_claims() {
    let mut r = Rng(20261122777);
    let (mut tried, mut accepted, mut falsely, mut certain_false) = (0,0,0,0);
    let start = std::time::Instant::now();
    while start.elapsed().as_secs() < 100 {
        let arms = r.below(2)==0;
        let n = 3 + usize::from(r.below(4)==0);
        let legs = machine(&mut r, arms, n);
        // a point that all reach
        let mut c = None;
        for _ in 0..200 { let p=[q(r.range(-4.0,4.0)),q(r.range(-4.0,4.0)),q(r.range(-4.0,4.0))]; if sv(&legs,p).is_some_and(|s| s[0]>1e-2) {c=Some(p);break} }
        let Some(c) = c else { continue };
        let h = q(r.range(0.02,1.0)*0.4).max(1.0/64.0);
        let round = r.below(3)==0;
        let (lo,hi) = (c.map(|x| x-h), c.map(|x| x+h));
        let mut ext = [f64::MAX, 0.0]; let mut joint = 0f64; let mut margin=f64::MAX; let mut ok = true;
        let inside = |p: V| !round || (p[0]-c[0]).powi(2)+(p[1]-c[1]).powi(2) <= h*h;
        let mut conditioning = 0f64;
        for i in 0..11*11*11 { let t=[i%11,i/11%11,i/121]; let p: V = std::array::from_fn(|k| lo[k]+(hi[k]-lo[k])*t[k] as f64/10.0);
            if !inside(p) { continue }
            match sv(&legs,p) { None => {ok=false}, Some(s) => { ext[0]=ext[0].min(s[0]); ext[1]=ext[1].max(s[1]); conditioning=conditioning.max(s[1]/s[0]);
                joint=joint.max(dot(legs[0].row(p).unwrap(),legs[0].row(p).unwrap()).sqrt());
                if n==3 { let u: Vec<V>=legs.iter().map(|l| unit(l.solve(p).unwrap().1)).collect(); margin=margin.min(dot(u[0],cross(u[1],u[2])).abs()); } } } }
        let slack = [0.995, 0.9995, 1.001, 1.03][r.below(4)];
        // bounds so many times as far as the samples say; < 1 is false.
        let (which, req, truth) = match r.below(5) {
            0 => ("sigma_min", format!(r#"{{"quantity":"transmission","end":"max","bound":"{}"}}"#, num(slack/ext[0])), slack>=1.0),
            1 => ("sigma_max", format!(r#"{{"quantity":"transmission","end":"min","bound":"{}"}}"#, num(1.0/(slack*ext[1]))), slack>=1.0),
            2 => ("conditioning", format!(r#"{{"quantity":"conditioning","end":"max","bound":"{}"}}"#, num(slack*conditioning)), slack>=1.0),
            3 => ("joint_speed", format!(r#"{{"quantity":"joint_speed","leg":1,"tool":"2","end":"max","bound":"{}"}}"#, num(2.0*joint*slack*if arms {180.0/std::f64::consts::PI} else {1.0})), slack>=1.0),
            _ => if n==3 {("parallel", format!(r#"{{"quantity":"parallel_margin","end":"min","bound":"{}"}}"#, num(margin/slack)), slack>=1.0)} else {("none", String::new(), true)},
        };
        if req.contains(r#""0""#) || !ok && r.below(4)!=0 { continue }
        let v = |x: V| format!(r#"["{}","{}","{}"]"#, num(x[0]),num(x[1]),num(x[2]));
        let ws = if round { format!(r#"{{"cylinder":{{"center":["{}","{}"],"radius":"{}","z":["{}","{}"]}}}}"#, num(c[0]),num(c[1]),num(h),num(lo[2]),num(hi[2])) } else { format!(r#"{{"box":{{"min":{},"max":{}}}}}"#, v(lo),v(hi)) };
        let t = text(&legs,&ws,&req);
        let cl = claim(&t);
        if Problem::new(&cl).is_err() { continue }
        tried += 1;
        let truth = truth && ok;
        if !truth { certain_false += 1 }
        if let Some(cert) = certify(&cl, if truth {3000} else {700}) {
            if check(&cert).is_ok() { accepted += 1; if !truth { falsely += 1; println!("FALSE {which} slack {slack} ok {ok}: {t}") } }
        }
    }
    println!("near: {tried} tried, {certain_false} false ones, {accepted} accepted, {falsely} falsely");
}
