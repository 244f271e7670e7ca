//! Bounds of the derivatives of a polyconic surface over its cells, by intervals of its control functions.

use super::{
    super::{
        interval::{Box3, Interval, shifted, taylor_ranges},
        part::{Count, Enclose, Enclosure, Form, Rectangle, Survey},
        sheet::Jet,
    },
    Control, Course, Flat, GREATEST_FULLNESS, LEAST_FULLNESS, PolyConicSheet, controls, section, weight,
};
use crate::Vec3;

/// Distance from a limit of the parameters that is rounding.
const AT_END: f64 = 1e-9;
/// Coefficients of a control function by the station parameter: the seventh power of a squared root, and the root.
const COEFFICIENTS: usize = 15;
/// Nodes of a tree that wait to be looked at, usually.
const DEEP: usize = 32;
/// Number of the function that is the fullness.
const FULLNESS: usize = 6;

impl PolyConicSheet {
    /// A control function over a range of the station parameter.
    fn course_range(&self, function: usize, [s, half]: [f64; 2]) -> Course<Interval> {
        let polynomial = self.form.polynomials.get(function).copied().unwrap_or_default();
        let mut coefficients = [0.0; COEFFICIENTS];
        let step = if self.form.roots.is_some() { 2 } else { 1 };
        for (place, k) in coefficients.iter_mut().step_by(step).zip(polynomial) {
            *place = k;
        }
        coefficients[1] += self.form.roots.and_then(|roots| roots.get(function).copied()).unwrap_or(0.0);
        taylor_ranges(&shifted(&coefficients, s), half)
    }

    /// The weight over a range of the station parameter, and whether it has a bend there because the fullness is held.
    fn weight_range(&self, range: [f64; 2]) -> (Course<Interval>, bool) {
        let [p, p1, p2] = self.course_range(FULLNESS, range);
        let held = |x: f64| x.clamp(LEAST_FULLNESS, GREATEST_FULLNESS);
        let within = Interval { low: held(p.low), high: held(p.high) };
        if within == p {
            (weight([p, p1, p2]), false)
        } else {
            // Where it is held it does not change.
            let some = |x: Interval| Interval { low: x.low.min(0.0), high: x.high.max(0.0) };
            let constant = within.low == within.high;
            let rates = if constant { [Interval::from(0.0); 2] } else { [some(p1), some(p2)] };
            (weight([within, rates[0], rates[1]]), !constant)
        }
    }
}

impl Enclose for PolyConicSheet {
    fn parts(&self) -> &Count {
        &self.parts
    }

    fn middle_of(&self, Rectangle { middle: [t, s], .. }: &Rectangle) -> Jet {
        self.jet(*t, *s)
    }

    fn enclose(&self, rectangle: &Rectangle) -> Enclosure {
        let Rectangle { middle: [t, s], half: [along, across] } = *rectangle;
        let jet = self.middle_of(rectangle);
        let range = [s, across];
        let (weight, bent) = self.weight_range(range);
        let mut courses: [Course<Interval>; 6] = std::array::from_fn(|k| self.course_range(k, range));
        // From the place in the middle, so that intervals of places are small: L and H carry it.
        for (k, value) in [(4, jet.point.y), (5, jet.point.z)] {
            courses[k][0] = courses[k][0] - Interval::from(value);
        }
        let t_range = Interval::about(t, along);
        let ends = [t < 0.0, t > 1.0];
        let controls = controls(courses);
        let [places, .., dtt, dts, dss] = section(&controls, &weight, t_range, ends);
        let lift = |x: f64, [y, z]: Flat<Interval>| Box3([Interval::from(x), y, z]);
        let [_, station_rate, station_bend] = self.station(s);
        // Places of a conic are within the triangle of its control points.
        let length = self.form.length.abs() * (station_rate.abs() + 0.5 * station_bend * across) * across;
        let flat = |place: &Flat<Interval>| place[0].magnitude().hypot(place[1].magnitude());
        let corner = |control: &Control<Interval>| flat(&control[0]);
        let reach = match ends {
            [false, false] => controls.iter().map(corner).fold(0.0, f64::max),
            _ => flat(&places),
        };
        let ([low, high], [first, last]) = (rectangle.range(0), rectangle.range(1));
        let [[t0, t1], [s0, s1]] = self.limits;
        let outer = low <= t0 + AT_END || high >= t1 - AT_END || first <= s0 + AT_END || last >= s1 - AT_END;
        // The natural normal turns over at the nose.
        let nose = self.form.roots.is_some() && first <= AT_END && last >= -AT_END;
        Enclosure {
            jet,
            duu: lift(0.0, dtt),
            duv: lift(0.0, dts).scaled(self.turned(s)),
            dvv: lift(self.form.length * station_bend, dss),
            reach: reach.hypot(length),
            sharp: [outer || nose || bent; 2],
            split: bent,
            ends: outer || nose,
        }
    }
}

impl PolyConicSheet {
    /// The direction across the conics, if all of them are the same.
    pub(in super::super) fn common_ruling(&self) -> Option<Vec3> {
        let roots = self.form.roots.is_some_and(|roots| roots.iter().any(|k| *k != 0.0));
        let same = !roots && self.form.polynomials.iter().all(|p| p.iter().skip(1).all(|k| *k == 0.0));
        if same { self.form.map.linear().tr_mul(&Vec3::x()).try_normalize(0.0) } else { None }
    }

    /// How far the surface is off its conics, along the natural normal.
    pub(in super::super) fn thickness(&self) -> f64 {
        self.form.thickness
    }

    /// Answers a question about the conics' surface, asked in program coordinates.
    pub(in super::super) fn survey<'a>(&self, survey: Survey<'a>) -> Survey<'a> {
        let own = self.form.map.apply_point(survey.center());
        let mut survey = survey.within(own, |way| self.form.map.apply_vector(way));
        let mut open = Vec::with_capacity(DEEP);
        open.push(0usize);
        while let Some(node) = open.pop() {
            let Some(cell) = self.cells.get(node).filter(|cell| cell.radius >= 0.0) else { continue };
            survey.counts_node();
            if cell.summary.is_some_and(|all| survey.is_settled_by(&all))
                || (own - cell.center).norm() > survey.reach() + cell.radius
            {
                continue;
            }
            match &cell.part {
                Some(part) => part.survey(self, &mut survey),
                None => {
                    // What bends most first: much of the rest then adds nothing.
                    let [first, second] = [2 * node + 1, 2 * node + 2];
                    let summary = |k: usize| self.cells.get(k).and_then(|cell| cell.summary);
                    let bent = |k: usize| summary(k).map(|all| all.curvature(survey.side()));
                    let other = bent(first) < bent(second);
                    open.extend(if other { [first, second] } else { [second, first] });
                }
            }
        }
        survey
    }

    /// How the conics' surface bends, asked and told in program coordinates.
    pub(in super::super) fn forms(&self, asked: Survey<'_>) -> Option<Vec<Form>> {
        let linear = self.form.map.linear();
        let forms = self.survey(asked).forms()?;
        Some(forms.iter().map(|form| form.turned(&linear)).collect())
    }
}
