//! Values in doubles against those of another program, in 40 digits.

use super::claim;
use orthocert::search::solver::sample::Sampler;
use orthocert_kernel::problem::Problem;
use serde_json::Value;

fn number(text: &Value) -> f64 {
    let text = text.as_str().unwrap();
    let (p, q) = text.split_once('/').unwrap_or((text, "1"));
    p.parse::<f64>().unwrap() / q.parse::<f64>().unwrap()
}

#[test]
fn joints_and_singular_values_are_the_oracle_s() {
    let text = include_str!("../../proofs/kernel/tests/oracle/points.json");
    let file: Value = serde_json::from_str(text).unwrap();
    let mut reached = 0;
    for case in file["cases"].as_array().unwrap() {
        let mut design = "[mechanism]\nkind = \"translational\"\n".to_owned();
        for leg in case["legs"].as_array().unwrap() {
            design.push_str("[[mechanism.legs]]\ndrive = \"slider\"\n");
            for key in ["direction", "anchor", "platform", "length", "mode"] {
                design.push_str(&format!("{key} = {}\n", leg[key]));
            }
        }
        design.push_str("[workspace]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n");
        let claim = claim(&(design + "[requirements]\nconditioning = { max = 100 }\n"));
        let problem = Problem::new(&claim).unwrap();
        let sampler = Sampler::new(&claim, &problem).unwrap();
        let unit = sampler.unit();
        for entry in case["points"].as_array().unwrap() {
            let point = [0, 1, 2].map(|k| number(&entry["point"][k]) / unit);
            let values = sampler.at_point(&point);
            let radicands = problem.legs.iter().map(|leg| values.of(leg.row.d));
            let is_reached = radicands.clone().all(|d| d.is_some_and(|d| d > 0.0));
            assert_eq!(entry["reachable"], is_reached, "{entry}");
            if !is_reached {
                continue;
            }
            reached += 1;
            let near = |x: f64, value: &Value| {
                let value = number(value);
                assert!((x - value).abs() < 1e-10 * (1.0 + value.abs()), "{x} {value} {entry}");
            };
            near(sampler.determinant(&values).unwrap(), &entry["det"]);
            let [least, greatest] = sampler.xi(&values).unwrap();
            near(least, &entry["singular_values"][0]);
            near(greatest, &entry["singular_values"][2]);
            for (i, leg) in problem.legs.iter().enumerate() {
                let Some(orthocert_kernel::machine::Joint::Length(rho)) = leg.rho else {
                    panic!("a slider")
                };
                near(values.of(rho).unwrap() * unit, &entry["rho"][i]);
            }
        }
    }
    assert_eq!(reached, 118 + 40 + 60 + 60);
}
