//! Findings that rest on identities.

use super::{value, Agreement, Basis, Finding, NotEstablished};
use crate::exact::Exact;

/// `L` of the prototype, in mm.
const LENGTH: &str = "200/(1/sqrt(18)+1/sqrt(6))";

/// Checks that an expression folds to the rational number `expected`.
fn identity(id: &'static str, expression: &str, expected: &str) -> Result<(), NotEstablished> {
    let number = |text: &str| {
        Exact::parse(text, 100).map_err(|e| NotEstablished { id, reason: format!("{text}: {e}") })
    };
    if number(expression)? == number(expected)? {
        Ok(())
    } else {
        Err(NotEstablished { id, reason: format!("{expression} is not {expected}") })
    }
}

/// The findings without certificates.
pub(super) fn findings() -> Result<Vec<Finding>, NotEstablished> {
    let mut all = dimensions()?;
    all.extend(corners_of_bounds()?);
    all.extend(singularities()?);
    all.extend(appendix()?);
    Ok(all)
}

fn dimensions() -> Result<Vec<Finding>, NotEstablished> {
    let of_length = |rest: &str| format!("{LENGTH}{rest}");
    Ok(vec![
        Finding {
            id: "leg-length",
            place: "Step 2",
            says: "L = 310 mm",
            proved: "L = 200 mm / (1/sqrt(18) + 1/sqrt(6))",
            agreement: Agreement::Corrected,
            values: vec![value("leg-length", "L (mm)", LENGTH)?],
            basis: Basis::Algebra(
                "q2 - q1 = L (t1/sqrt(1+2 t1^2) + t2/sqrt(1+2 t2^2)) with t1 = 1/4, t2 = 1/2",
            ),
        },
        Finding {
            id: "corners",
            place: "Step 2",
            says: "q_k = -sin(beta_Qk) L",
            proved: "q_k = +sin(beta_Qk) L: q1 < 0 < q2, and only so is eta > 0 in Step 3",
            agreement: Agreement::Corrected,
            values: vec![
                value("corners", "q1 (mm)", &of_length("*(-1)/sqrt(18)"))?,
                value("corners", "q2 (mm)", &of_length("/sqrt(6)"))?,
            ],
            basis: Basis::Algebra("a = q1 - e - L gives rho_1(Q1) = L - s(Q1) >= 0 with this sign"),
        },
        Finding {
            id: "base",
            place: "Step 3",
            says: "a = OA_i is a distance",
            proved: "a = q1 - e - L is negative: a coordinate along the axis, here for e = 0",
            agreement: Agreement::Corrected,
            values: vec![value("base", "a (mm)", &of_length("*(-1/sqrt(18)-1)"))?],
            basis: Basis::Algebra("a = q1 - e - L with q1 < 0, e >= 0, L > 0"),
        },
        Finding {
            id: "rho-min-place",
            place: "Step 3",
            says: "at Q1, rho_1 = rho_2 = rho_3 = rho_min",
            proved:
                "rho_min = 0 is attained where P is on the axis: at Q1', the projection of Q1; \
                     at Q1 rho_i = L - s(Q1) is greater",
            agreement: Agreement::Fails,
            values: vec![value("rho-min-place", "rho_i(Q1) (mm)", &of_length("*(1-sqrt(8/9))"))?],
            basis: Basis::Algebra(
                "rho_1 = (x - q1) + (L - s_1), both terms non-negative on the cube; s_1 = L only \
                 where y = z = 0",
            ),
        },
        Finding {
            id: "ratio",
            place: "Step 3",
            says: "r, joint range over workspace size, = 200/257",
            proved: "200/257 is workspace size over joint range",
            agreement: Agreement::Corrected,
            values: vec![value(
                "ratio",
                "cube side / rho_max",
                "200/(200+200/(1/sqrt(18)+1/sqrt(6))*(1-sqrt(2/3)))",
            )?],
            basis: Basis::Algebra("the quotient of the numbers above is less than 1"),
        },
    ])
}

fn corners_of_bounds() -> Result<Vec<Finding>, NotEstablished> {
    // At P = (c, c, c) the singular values of M are |1 + 2m| and, twice, |1 - m|.
    identity("equality", "1+2*(-1/4)", "1/2")?;
    identity("equality", "1+2*(1/2)", "2")?;
    identity("equality", "1-1/2", "1/2")?;
    Ok(vec![
        Finding {
            id: "equality",
            place: "Step 1",
            says: "the bounds are reached at Q1 and Q2",
            proved: "at Q1 one psi is 2; at Q2 one psi is 1/2 and two are 2: equality, three times",
            agreement: Agreement::Holds,
            values: Vec::new(),
            basis: Basis::Algebra(
                "M = (1 - m) I + m 11^T with m(Q1) = -1/4, m(Q2) = 1/2: singular values |1 + 2m| \
                 once and |1 - m| twice",
            ),
        },
        Finding {
            id: "ellipsoid",
            place: "Section on the transmission factors",
            says: "p'^T (J J^T) p' <= 1, with semi-axes xi_i",
            proved: "the image of the unit ball under J is p'^T (J J^T)^{-1} p' <= 1, with \
                     semi-axes psi_i = 1/xi_i",
            agreement: Agreement::Fails,
            values: Vec::new(),
            basis: Basis::Algebra(
                "p' = J rho' and |rho'| <= 1 give p'^T (J J^T)^{-1} p' = |rho'|^2 <= 1",
            ),
        },
    ])
}

fn singularities() -> Result<Vec<Finding>, NotEstablished> {
    // The second isotropic configuration: s = L/3, coordinates -2L/3, m = -2, all factors 3.
    identity("isotropy", "1/9+2*(2/3)*(2/3)", "1")?;
    identity("isotropy", "1+2*(-2)", "-3")?;
    identity("isotropy", "1-(-2)", "3")?;
    Ok(vec![
        Finding {
            id: "serial-surfaces",
            place: "Section on singular configurations",
            says: "serial singularities form three planes",
            proved: "eta_1 = 0 is the cylinder y^2 + z^2 = L^2, and likewise for the other legs",
            agreement: Agreement::Fails,
            values: Vec::new(),
            basis: Basis::Algebra("eta_1 = s_1 = sqrt(L^2 - y^2 - z^2)"),
        },
        Finding {
            id: "isotropy",
            place: "Section on isotropy",
            says: "the isotropic configuration is unique",
            proved: "O is the only isotropic point of the workspace, and the only one with psi = 1; \
                     elsewhere there is one more, P = -(2L/3)(1,1,1), with psi = 1/3, beyond a \
                     parallel singularity",
            agreement: Agreement::Corrected,
            values: Vec::new(),
            basis: Basis::Algebra(
                "rows of M of equal length have equal s_i, so x^2 = y^2 = z^2; orthogonal rows give \
                 x s = -x^2/2 and so on, so each coordinate is 0 or -2s, all alike; the latter is \
                 s = L/3, and 1 + 2m has changed sign",
            ),
        },
    ])
}

fn appendix() -> Result<Vec<Finding>, NotEstablished> {
    let id = "appendix-roots";
    // With f_1 = |2t - 1| and f_2 = 1/|t + 1|: (2t - 1)(t + 1) = -1 at 0 and -1/2.
    identity(id, "(2*0-1)*(0+1)", "-1")?;
    identity(id, "(2*(-1/2)-1)*(-1/2+1)", "-1")?;
    // 2t^2 + t - 2 = 0 at (-1 -+ sqrt 17)/4: sum -1/2 and product -1 of the roots.
    identity(id, "(1-17)/16", "-1")?;
    Ok(vec![
        Finding {
            id,
            place: "Appendix",
            says: "f_2 = |tan(theta) + 1|, with the four roots s_1 to s_4 of f_1 = f_2",
            proved: "with f_2 = 1/|tan(theta) + 1| the roots are tan = -(1+sqrt 17)/4, -1/2, 0, \
                     (sqrt 17 - 1)/4, and f_1(s_1) = (3+sqrt 17)/2, f_1(s_4) = (sqrt 17 - 3)/2",
            agreement: Agreement::Corrected,
            values: vec![
                value(id, "f_1(s_1)", "(3+sqrt(17))/2")?,
                value(id, "f_1(s_4)", "(sqrt(17)-3)/2")?,
            ],
            basis: Basis::Algebra("(2t - 1)(t + 1) = 1 or -1: 2t^2 + t - 2 = 0 or 2t^2 + t = 0"),
        },
        Finding {
            id: "appendix-count",
            place: "Appendix",
            says: "four roots in [-pi, pi]",
            proved: "four roots in (-pi/2, pi/2), eight in [-pi, pi]",
            agreement: Agreement::Corrected,
            values: Vec::new(),
            basis: Basis::Algebra("four values of tan(theta), whose period is pi"),
        },
        Finding {
            id: "appendix-inequations",
            place: "Appendix",
            says: "the bounds are two inequations in |2 tan(theta) - 1|",
            proved:
                "the two inequations in |tan(theta) + 1| are needed as well: they decide at Q2 \
                     for psi_max >= 2",
            agreement: Agreement::Corrected,
            values: Vec::new(),
            basis: Basis::Algebra(
                "singular values |1 + 2m| once and |1 - m| twice; m = -tan(theta)",
            ),
        },
        Finding {
            id: "case-split",
            place: "Appendix",
            says: "theta_Q2 is split at psi_max = f_1(s_4), with an upper limit at f_1(s_1)",
            proved: "t2 = 1 - kappa for psi_max >= 2, (1/kappa - 1)/2 for psi_max <= 2, and no \
                     upper limit: the postulate is proved for every psi_max",
            agreement: Agreement::Corrected,
            values: Vec::new(),
            basis: Basis::Algebra(
                "1 - m >= kappa and 1 + 2m <= 1/kappa; the first is the sharper one exactly for \
                 kappa <= 1/2, as 1 + 2 (1 - kappa) <= 1/kappa is (1 - kappa)(1 - 2 kappa) >= 0",
            ),
        },
    ])
}
