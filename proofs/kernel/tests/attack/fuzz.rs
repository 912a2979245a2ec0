use num_bigint::BigInt;
use orthocert_kernel::arithmetic::*;
use orthocert_kernel::cell::*;
use orthocert_kernel::fixed::*;
use orthocert_kernel::formula::*;
use orthocert_kernel::slope::*;

pub struct Rng(pub u64);
impl Rng {
    pub fn next(&mut self) -> u64 { self.0 ^= self.0 << 13; self.0 ^= self.0 >> 7; self.0 ^= self.0 << 17; self.0.wrapping_mul(0x2545F4914F6CDD1D) >> 11 }
    pub fn below(&mut self, n: usize) -> usize { (self.next() % n as u64) as usize }
    pub fn unit(&mut self) -> f64 { (self.next() % (1 << 40)) as f64 / (1u64 << 40) as f64 }
    pub fn range(&mut self, a: f64, b: f64) -> f64 { a + (b - a) * self.unit() }
}

fn tape(r: &mut Rng, m: usize) -> Tape {
    let mut t = Tape::default();
    let mut f: Vec<Formula> = (0..m).map(|k| t.coordinate(k)).collect();
    f.push(t.parameter(0)); f.push(t.integer(3)); f.push(t.integer(-1));
    for _ in 0..14 {
        let (a, b) = (f[r.below(f.len())], f[r.below(f.len())]);
        let n = match r.below(8) { 0 => t.add(a, b), 1 => t.sub(a, b), 2 | 3 => t.mul(a, b), 4 => t.div(a, b), 5 => t.sqr(a), 6 => t.neg(a),
            _ => t.sqrt(a) };
        f.push(n);
    }
    t
}

#[test]
fn slopes() {
    let mut r = Rng(88172645463325252);
    let (mut entries, mut words, mut tight) = (0usize, 0usize, 0usize);
    for case in 0..60000 {
        let m = 1 + r.below(3);
        let t = tape(&mut r, m);
        let bits = [32u32, 40, 52, 59][r.below(4)];
        let fine = 300u32;
        let one = 1i64 << bits.min(50);
        let _ = one;
        let cell: Vec<Interval<BigInt>> = (0..m).map(|_| {
            let w = 2f64.powi(-(r.below(20) as i32));
            let a = r.range(-2.0, 2.0); let b = a + w * r.unit();
            let z = |x: f64| BigInt::from((x * 2f64.powi(50)) as i64) << 64usize >> (114 - bits) as usize;
            Interval { lo: z(a), hi: z(b) } }).collect();
        let plo = BigInt::from((r.range(-2.0, 2.0) * 2f64.powi(30)) as i64) << (bits - 30);
        let phi = &plo + BigInt::from(r.below(1 << 12));
        let big = Fixed::<BigInt>::new(bits);
        let s = Slopes { arithmetic: &big, m };
        let c = Cell(cell.clone());
        let edges = c.edges().unwrap();
        let v = evaluate(&t, &[Interval { lo: plo.clone(), hi: phi.clone() }], s, &edges);
        // words
        let wcell: Option<Vec<Interval<i64>>> = cell.iter().map(|x| Some(Interval { lo: <i64 as Integer>::of(&x.lo)?, hi: <i64 as Integer>::of(&x.hi)? })).collect();
        if let Some(wc) = wcell {
            let wf = Fixed::<i64>::new(bits);
            let ws = Slopes { arithmetic: &wf, m };
            if let (Some(e), Some(pl), Some(ph)) = (Cell(wc).edges(), <i64 as Integer>::of(&plo), <i64 as Integer>::of(&phi)) {
                let wv = evaluate(&t, &[Interval { lo: pl, hi: ph }], ws, &e);
                let mut known = Tape::default(); let _ = &mut known;
                for i in 0..t.ops().len() {
                    let f = formula_at(&t, i);
                    if let Some(w) = wv.of(f) {
                        let b = v.of(f).expect("words accept, integers do not");
                        let same = |x: &Interval<i64>, y: &Interval<BigInt>| BigInt::from(x.lo) == y.lo && BigInt::from(x.hi) == y.hi;
                        assert!(same(&w.range, &b.range) && same(&w.at_centre, &b.at_centre) && (0..m).all(|k| same(&w.slopes[k], &b.slopes[k])), "case {case} op {:?}", t.ops()[i]);
                        words += 1;
                    }
                }
            }
        }
        // points
        for _ in 0..3 {
            let fx = Fixed::<BigInt>::new(fine);
            let den = 1i64 << 20;
            let lam: Vec<i64> = (0..m).map(|_| match r.below(4) { 0 => 0, 1 => den, _ => r.below(den as usize + 1) as i64 }).collect();
            let x: Vec<BigInt> = cell.iter().zip(&lam).map(|(c, l)| (&c.lo << (fine - bits)) + (((&c.hi - &c.lo) * l) << (fine - bits - 20))).collect();
            let p: BigInt = &plo + (&phi - &plo) * (r.below(1025) as i64) / 1024;
            let p: BigInt = p << (fine - bits);
            let at = |x: &[BigInt]| t.run(&fx, |op| match op { Op::Coordinate(k) => Some(Interval::point(x[k].clone())), Op::Parameter(_) => Some(Interval::point(p.clone())), _ => None });
            let here = at(&x);
            let centre: Vec<BigInt> = edges.iter().map(|e| &e[0].lo << (fine - bits)).collect();
            let mid = at(&centre);
            for i in 0..t.ops().len() {
                let f = formula_at(&t, i);
                let Some(b) = v.of(f) else { continue };
                let (Some(h), Some(c)) = (here.of(f), mid.of(f)) else { panic!("case {case}: defined over the cell, not at a point: {:?}", t.ops()[i]) };
                let up = |z: &BigInt| z << (fine - bits);
                assert!(h.hi >= up(&b.range.lo) && h.lo <= up(&b.range.hi), "case {case} range {:?}", t.ops()[i]);
                assert!(c.hi >= up(&b.at_centre.lo) && c.lo <= up(&b.at_centre.hi), "case {case} centre");
                // f(x) - f(c) in sum S lambda
                let mut lo = BigInt::from(0); let mut hi = BigInt::from(0);
                for k in 0..m {
                    let half = &edges[k][2].lo << (fine - bits);
                    if half == BigInt::from(0) { continue }
                    // S * lambda, lambda = (x - c)/half
                    let d = &x[k] - &centre[k];
                    let q = |s: &BigInt| (up(s) * &d) / &half;
                    let (a, bb) = (q(&b.slopes[k].lo), q(&b.slopes[k].hi));
                    lo += (&a).min(&bb); hi += a.max(bb);
                }
                let slack = BigInt::from(8);
                assert!(&h.hi - &c.lo >= lo - &slack && &h.lo - &c.hi <= hi + &slack, "case {case} slopes {:?}", t.ops()[i]);
                entries += 1;
                if b.range.lo != b.range.hi { tight += 1 }
            }
        }
    }
    println!("slopes: {entries} entries x points, {tight} wide, {words} words equal");
}

pub fn formula_at(t: &Tape, i: usize) -> Formula {
    // Formulas are built by pushing; an equal op gives the entry.
    let mut copy = t.clone();
    match t.ops()[i] {
        Op::Coordinate(k) => copy.coordinate(k), Op::Parameter(k) => copy.parameter(k), Op::Integer(n) => copy.integer(n),
        Op::Add(a, b) => copy.add(a, b), Op::Sub(a, b) => copy.sub(a, b), Op::Neg(a) => copy.neg(a), Op::Mul(a, b) => copy.mul(a, b),
        Op::Div(a, b) => copy.div(a, b), Op::Sqr(a) => copy.sqr(a), Op::Sqrt(a) => copy.sqrt(a),
    }
}

#[test]
fn gradients() {
    let mut r = Rng(987654321);
    let (mut checked, mut singular, mut lost, mut lively) = (0, 0, 0, 0);
    for case in 0..4000 {
        let m = 1 + r.below(3);
        let t0 = tape(&mut r, m);
        let f = formula_at(&t0, t0.ops().len() - 1);
        let mut t = t0.clone();
        let g = t.gradient(f, m);
        let d = t.square_without_roots(g.denominator);
        let bits = 400;
        let fx = Fixed::<BigInt>::new(bits);
        let p = BigInt::from((r.range(-2.0, 2.0) * 2f64.powi(40)) as i64) << (bits - 40);
        let x: Vec<BigInt> = (0..m).map(|_| BigInt::from((r.range(-2.0, 2.0) * 2f64.powi(40)) as i64) << (bits - 40)).collect();
        let run = |t: &Tape, x: &[BigInt]| t.run(&fx, |op| match op { Op::Coordinate(k) => Some(Interval::point(x[k].clone())), Op::Parameter(_) => Some(Interval::point(p.clone())), _ => None });
        let dbl = |x: &Interval<BigInt>| { use num_traits::ToPrimitive; (&x.lo >> (bits - 200)).to_f64().unwrap() * 2f64.powi(-200) };
        let v = run(&t, &x);
        let defined = v.of(f).is_some();
        let rowok = v.of(d).is_some_and(|d| fx.is_positive(d)) && g.numerators.iter().all(|&n| v.of(n).is_some());
        if rowok && !defined { lost += 1; if g.numerators.iter().any(|&n| t.ops().iter().enumerate().all(|(i, o)| formula_at(&t, i) != n || !matches!(o, Op::Integer(0)))) { lively += 1; if lively < 6 { println!("lively {:?}", t0.ops()); } } continue }
        if !defined { singular += 1; continue }
        let h = BigInt::from(1) << (bits - 100);
        for k in 0..m {
            let mut a = x.clone(); a[k] += &h; let mut b = x.clone(); b[k] -= &h;
            let (va, vb) = (run(&t0, &a), run(&t0, &b));
            let (Some(fa), Some(fb)) = (va.of(f), vb.of(f)) else { continue };
            let num = fx.div(&fx.sub(fa, fb).unwrap(), &Interval::point(&h * 2)).unwrap();
            let e = v.of(g.denominator).expect("denominator");
            let sym = fx.div(v.of(g.numerators[k]).unwrap(), e).unwrap();
            let (a, b) = (dbl(&num), dbl(&sym));
            assert!((a - b).abs() <= 1e-6 * (1.0 + a.abs()), "case {case}: {a} {b} {:?}", t0.ops());
            let (e2, d) = (dbl(e).powi(2), dbl(v.of(d).unwrap()));
            assert!((e2 - d).abs() <= 1e-6 * (1.0 + e2.abs()), "case {case}: E^2 {e2} D {d}");
            checked += 1;
        }
    }
    println!("gradients: {checked} checked, {singular} undefined, {lost} with row but no formula, {lively} of them with a gradient");
}
