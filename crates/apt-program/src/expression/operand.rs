//! The operands of statements, definitions and functions: parameters evaluated.

use std::sync::Arc;

use apt_geometry::{
    Vec3,
    canonical::{Geometry, Pattern},
    motion::NamedSurface,
};
use apt_syntax::{
    TextRange,
    statement::{Argument, Expression, Name},
    vocabulary::Word,
};
use smol_str::SmolStr;

use super::Resolved;
use crate::{
    evaluator::Evaluator,
    finding::{FindingKind, Found},
    symbols::{ArrayElement, Meaning},
};

/// Most elements that one inclusive subscript may deliver.
const MOST_INCLUSIVE_ELEMENTS: u32 = 100_000;

/// One evaluated operand.
#[derive(Debug, Clone)]
pub(crate) enum Operand {
    /// A number.
    Scalar(f64),
    /// Geometry in the coordinates of the reference system in force.
    Geometry {
        /// Its name, empty for a nest.
        name: SmolStr,
        /// The canonical form.
        geometry: Arc<Geometry>,
    },
    /// A vocabulary word.
    Word(&'static Word),
    /// Text in quotes.
    Text(SmolStr),
    /// An empty position.
    Empty,
}

/// An operand with its place.
#[derive(Debug, Clone)]
pub(crate) struct Item {
    /// The operand.
    pub(crate) operand: Operand,
    /// Where it stands.
    pub(crate) range: TextRange,
}

/// Low end, high end, and step with whether it goes up, of an inclusive subscript.
pub(crate) type Bounds<'e> = (Option<&'e Expression>, Option<&'e Expression>, Option<&'e (bool, Expression)>);

/// The element that a whole subscript names, if it is one of the array.
pub(crate) fn element_of(subscript: f64, extent: u32) -> Option<u32> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "inside 1..=extent")]
    (subscript >= 1.0 && subscript <= f64::from(extent)).then_some(subscript as u32)
}

/// Operands in order.
pub(crate) type Items = Vec<Item>;

impl Item {
    /// The number, if it is one.
    pub(crate) fn scalar(&self) -> Option<f64> {
        match self.operand {
            Operand::Scalar(value) => Some(value),
            _ => None,
        }
    }

    /// The spelling, if it is a word.
    pub(crate) fn word(&self) -> Option<&'static str> {
        match self.operand {
            Operand::Word(word) => Some(word.spelling),
            _ => None,
        }
    }

    /// The geometry, if it is some.
    pub(crate) fn geometry(&self) -> Option<&Geometry> {
        match &self.operand {
            Operand::Geometry { geometry, .. } => Some(geometry),
            _ => None,
        }
    }

    /// The coordinates, if it is a point.
    pub(crate) fn point(&self) -> Option<Vec3> {
        match self.geometry() {
            Some(Geometry::Point(point)) => Some(*point),
            _ => None,
        }
    }

    /// The components, if it is a vector.
    pub(crate) fn vector(&self) -> Option<Vec3> {
        match self.geometry() {
            Some(Geometry::Vector(vector)) => Some(*vector),
            _ => None,
        }
    }

    /// The pattern with its name, if it is one.
    pub(crate) fn pattern(&self) -> Option<(SmolStr, Arc<Pattern>)> {
        match &self.operand {
            Operand::Geometry { name, geometry } => match &**geometry {
                Geometry::Pattern(pattern) => Some((name.clone(), Arc::clone(pattern))),
                _ => None,
            },
            _ => None,
        }
    }

    /// The name of the geometry, empty for anything else.
    pub(crate) fn name(&self) -> SmolStr {
        match &self.operand {
            Operand::Geometry { name, .. } => name.clone(),
            _ => SmolStr::default(),
        }
    }

    /// The surface with its name, if the geometry is one that a tool can follow.
    pub(crate) fn surface(&self) -> Option<NamedSurface> {
        match &self.operand {
            Operand::Geometry { name, geometry } if geometry.kind().is_surface() => {
                Some(NamedSurface { name: name.to_string(), geometry: (**geometry).clone() })
            }
            _ => None,
        }
    }

    /// What it is, as evidence.
    pub(crate) fn found(&self) -> Found {
        match &self.operand {
            Operand::Scalar(_) => Found::Scalar,
            Operand::Geometry { geometry, .. } => Found::Geometry(geometry.kind()),
            Operand::Word(word) => Found::Word(SmolStr::new_static(word.spelling)),
            Operand::Text(_) => Found::Text,
            Operand::Empty => Found::Nothing,
        }
    }
}

impl Evaluator<'_> {
    /// All operands of a list; nothing if one of them has no value. Every mistake of the list is reported.
    pub(crate) fn operands(&mut self, arguments: &[Argument]) -> Option<Items> {
        let mut items = Vec::with_capacity(arguments.len());
        let mut complete = true;
        for argument in arguments {
            complete &= self.operand(argument, &mut items).is_some();
        }
        complete.then_some(items)
    }

    /// Reports inclusive subscripts in a list that takes none; nothing if there are some.
    pub(crate) fn refuse_inclusive(&mut self, arguments: &[Argument]) -> Option<()> {
        let inclusive = arguments.iter().find_map(|argument| match argument {
            Argument::Inclusive { name, range, .. } => Some((name.text.clone(), *range)),
            _ => None,
        });
        let Some((name, range)) = inclusive else { return Some(()) };
        self.report(FindingKind::InclusiveNotHere { name }, range);
        None
    }

    /// Evaluates one parameter; an inclusive subscript gives several operands.
    pub(crate) fn operand(&mut self, argument: &Argument, items: &mut Items) -> Option<()> {
        let range = argument.range();
        let operand = match argument {
            Argument::Empty(_) => Operand::Empty,
            Argument::Word(word) => Operand::Word(word.word),
            Argument::Text { text, .. } => Operand::Text(text.clone()),
            Argument::Expression(expression) => self.expression_operand(expression)?,
            Argument::Nested { target, definition, .. } => {
                self.nested_definition(target.as_ref(), definition, range)?
            }
            Argument::Point { coordinates, .. } => self.nested_point(coordinates, range)?,
            Argument::Inclusive { name, first, last, step, .. } => {
                return self.inclusive(name, first.as_ref(), last.as_ref(), step.as_ref(), range, items);
            }
        };
        items.push(Item { operand, range });
        Some(())
    }

    /// An expression that may be the name of geometry.
    fn expression_operand(&mut self, expression: &Expression) -> Option<Operand> {
        if let Expression::Number { value, .. } = expression {
            return Some(Operand::Scalar(*value));
        }
        let Some(reference) = Self::plain_reference(expression) else {
            return self.scalar(expression).map(Operand::Scalar);
        };
        match self.resolve(reference)? {
            Resolved::Scalar(value) => Some(Operand::Scalar(value)),
            Resolved::Geometry { name, stored } => {
                let Some(geometry) = stored.seen_from(self.state.system.as_ref()) else {
                    let kind = stored.geometry.kind();
                    self.report(FindingKind::Untransformable { kind }, reference.range);
                    return None;
                };
                Some(Operand::Geometry { name, geometry })
            }
        }
    }

    /// `(x,y)` or `(x,y,z)`.
    fn nested_point(&mut self, coordinates: &[Argument], range: TextRange) -> Option<Operand> {
        let items = self.operands(coordinates)?;
        let numbers: Option<Vec<f64>> = items.iter().map(Item::scalar).collect();
        let Some(numbers) = numbers else {
            let found = items.iter().find(|item| item.scalar().is_none()).map_or(Found::Nothing, Item::found);
            self.report(
                FindingKind::Operand {
                    statement: SmolStr::new_static("POINT"),
                    expected: crate::finding::Expected::Scalar,
                    found,
                    number: 1000,
                },
                range,
            );
            return None;
        };
        let point = match numbers.as_slice() {
            [x, y] => Vec3::new(*x, *y, self.z_over(*x, *y, range)?),
            [x, y, z] => Vec3::new(*x, *y, *z),
            _ => return None,
        };
        Some(Operand::Geometry { name: SmolStr::default(), geometry: Arc::new(Geometry::Point(point)) })
    }

    /// z of the ZSURF plane over a point.
    pub(crate) fn z_over(&mut self, x: f64, y: f64, range: TextRange) -> Option<f64> {
        let z = self.state.z_surface.z_over(x, y).filter(|z| z.is_finite());
        if z.is_none() {
            self.report(FindingKind::VerticalZSurface, range);
        }
        z
    }

    /// `A(2,THRU,ALL,INCR,2)`: the elements from the low end up, or from the high end down.
    fn inclusive(
        &mut self,
        name: &Name,
        first: Option<&Expression>,
        last: Option<&Expression>,
        step: Option<&(bool, Expression)>,
        range: TextRange,
        items: &mut Items,
    ) -> Option<()> {
        let key = self.array_key(&name.text);
        let (extent, subscripts) = self.inclusive_subscripts(name, (first, last, step), range)?;
        let mut complete = true;
        for subscript in subscripts {
            complete &= self.push_element(name, &key, subscript, extent, range, items).is_some();
        }
        complete.then_some(())
    }

    /// The extent of an array and the subscripts, whole numbers, that an inclusive subscript names in order; they may lie
    /// outside of the array. The first is always among them.
    pub(crate) fn inclusive_subscripts(
        &mut self,
        name: &Name,
        (first, last, step): Bounds<'_>,
        range: TextRange,
    ) -> Option<(u32, Vec<f64>)> {
        let key = self.array_key(&name.text);
        self.mark_used(&key);
        let extent = match self.look_up(&key).map(|symbol| &symbol.meaning) {
            Some(Meaning::Array(array)) => array.extent,
            Some(Meaning::Poisoned) => {
                self.unknown_values += 1;
                return None;
            }
            _ => {
                self.report(FindingKind::NotReserved { name: name.text.clone() }, range);
                return None;
            }
        };
        let low = first.map_or(Some(1.0), |expression| self.scalar(expression))?.trunc();
        let high = last.map_or(Some(f64::from(extent)), |expression| self.scalar(expression))?.trunc();
        let step = match step {
            None => 1.0,
            Some((up, size)) => {
                let size = self.scalar(size)?.trunc();
                if *up { size } else { -size }
            }
        };
        if step == 0.0 {
            self.report(FindingKind::InclusiveForm { name: name.text.clone() }, range);
            return None;
        }
        let (mut at, end) = if step > 0.0 { (low, high) } else { (high, low) };
        let mut subscripts = Vec::new();
        for _ in 0..MOST_INCLUSIVE_ELEMENTS {
            subscripts.push(at);
            at += step;
            if (step > 0.0 && at > end) || (step < 0.0 && at < end) {
                break;
            }
        }
        Some((extent, subscripts))
    }

    /// Adds one element of an array to the operands.
    fn push_element(
        &mut self,
        name: &Name,
        key: &SmolStr,
        at: f64,
        extent: u32,
        range: TextRange,
        items: &mut Items,
    ) -> Option<()> {
        let Some(index) = element_of(at, extent) else {
            let finding = FindingKind::SubscriptRange { name: name.text.clone(), subscript: at, extent };
            self.report(finding, range);
            return None;
        };
        let element = match self.look_up(key).map(|symbol| &symbol.meaning) {
            Some(Meaning::Array(array)) => array.get(index).cloned(),
            _ => None,
        };
        let element_name = smol_str::format_smolstr!("{}({index})", name.text);
        let operand = match element {
            Some(ArrayElement::Scalar(value)) => Operand::Scalar(value),
            Some(ArrayElement::Geometry(stored)) => {
                let geometry = stored.seen_from(self.state.system.as_ref())?;
                Operand::Geometry { name: element_name, geometry }
            }
            Some(ArrayElement::Poisoned) => {
                self.unknown_values += 1;
                return None;
            }
            None => {
                self.report(FindingKind::Undefined { name: element_name, similar: Vec::new() }, range);
                return None;
            }
        };
        items.push(Item { operand, range });
        Some(())
    }
}
