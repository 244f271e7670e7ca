//! Arcs: CIRCLE before positions or the end, MOVARC, and the drive surfaces of CATIA.

use std::f64::consts::{PI, TAU};

use apt_geometry::Vec3;

use super::Writer;
use crate::{
    arc::PathArc,
    geometry::SpaceCircle,
    record::ClPoint,
    text::{dialects::Circles, number::Field},
};

/// What rounding may add to a full turn.
const ANGLE_ROUNDING: f64 = 1e-9;

impl Writer<'_> {
    /// CIRCLE and all positions.
    pub(super) fn circle_before(&mut self, circle: &SpaceCircle, points: &[ClPoint]) {
        // MULTAX stands before the circle: a word between them would end it.
        self.prepare_axis(points);
        let numbers = self.circle_numbers(circle);
        self.statement("CIRCLE", &numbers);
        for (index, point) in points.iter().enumerate() {
            self.position(self.form.goto, point, index > 0);
        }
    }

    fn circle_numbers(&self, circle: &SpaceCircle) -> Vec<String> {
        // Columns are for positions alone, and blanks for zeros are for columns.
        let natural = |field: Field| match field.blank_zeros {
            true => Field::decimals(0),
            false => Field::decimals(field.decimals),
        };
        let (place, axis) = (natural(self.form.position), natural(self.form.axis));
        let mut list = self.fields(&circle.center, place);
        list.extend(self.fields(&circle.axis, axis));
        list.push(place.text(circle.radius));
        list
    }

    /// An arc of which the end alone is written, in as many pieces as the form needs. Every piece ends at a position of the record.
    pub(super) fn arc_by_end(&mut self, arc: &PathArc, start: &ClPoint, points: &[ClPoint]) {
        self.prepare_axis(points);
        let most = match self.form.circles {
            Circles::Driven => PI - ANGLE_ROUNDING,
            Circles::BeforeEnd => TAU + ANGLE_ROUNDING,
            _ => f64::INFINITY,
        };
        let (mut from, mut rest) = (*start, points);
        while let [first, more @ ..] = rest {
            let step =
                |one: &ClPoint, next: &ClPoint| arc.circle.angle_between(&one.position, &next.position);
            let (mut sweep, mut count) = (step(&from, first), 1);
            for pair in rest.windows(2) {
                let next = step(&pair[0], &pair[1]);
                if sweep + next > most {
                    break;
                }
                sweep += next;
                count += 1;
            }
            let end = rest[count - 1];
            // What is told of the whole is told to the last bit.
            let sweep = if count == points.len() { arc.sweep } else { sweep };
            self.piece(&arc.circle, &from, &end, sweep);
            from = end;
            rest = if count > 1 { &rest[count..] } else { more };
        }
    }

    fn piece(&mut self, circle: &SpaceCircle, start: &ClPoint, end: &ClPoint, sweep: f64) {
        if self.form.circles == Circles::Driven {
            return self.driven(circle, start, end);
        }
        let mut numbers = self.circle_numbers(circle);
        if self.form.circles == Circles::WithAngle {
            numbers.extend(["ANGLE".to_owned(), self.form.value.text(sweep.to_degrees())]);
            self.statement("MOVARC", &numbers);
        } else {
            self.statement("CIRCLE", &numbers);
        }
        self.position(self.form.goto, end, false);
    }

    /// The circle as drive surface: of its own name in a plane across z, else as a cylinder.
    fn driven(&mut self, circle: &SpaceCircle, start: &ClPoint, end: &ClPoint) {
        let along = circle.axis.cross(&circle.in_plane(&start.position)).normalize();
        let direction = self.fields(&along, Field { width: 9, ..self.form.position });
        self.statement("AUTOPS", &[]);
        self.statement("INDIRV", &direction);
        let join = |list: Vec<String>| list.join(",");
        let place = |at: &Vec3| join(self.fields(at, self.form.position));
        let (center, axis) = (place(&circle.center), join(self.fields(&circle.axis, self.form.axis)));
        let (radius, end) = (self.form.position.text(circle.radius), place(&end.position));
        let lines = if circle.axis.x == 0.0 && circle.axis.y == 0.0 {
            vec![
                format!("TLON,GOFWD/ (CIRCLE/{center},$"),
                format!("{radius}),ON,(LINE/{center},$"),
                format!("{end})"),
            ]
        } else {
            vec![
                format!("TLON,GOFWD/ (CYLNDR/{center},$"),
                format!("   {axis},{radius}),ON,$"),
                format!("    (PLANE/PERPTO,(PLANE/(POINT/{center}),$"),
                format!("    PERPTO,(VECTOR/{axis})),$"),
                format!("    (POINT/{center}),$"),
                format!("    (POINT/{end}))"),
            ]
        };
        lines.iter().for_each(|line| self.sheet.line(line));
    }
}
