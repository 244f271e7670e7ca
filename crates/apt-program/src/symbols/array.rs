//! Reserved arrays (language reference 2.7).

use super::Stored;

/// An array declared by RESERV: elements 1..=extent, all scalars or all geometry.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Array {
    /// The last subscript.
    pub(crate) extent: u32,
    /// Whether it holds geometry; not known before the first element is defined.
    pub(crate) holds_geometry: Option<bool>,
    elements: imbl::OrdMap<u32, ArrayElement>,
}

/// One element of an array.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum ArrayElement {
    /// A number.
    Scalar(f64),
    /// Geometry.
    Geometry(Stored),
    /// Its definition failed.
    Poisoned,
}

impl Array {
    /// An array without defined elements.
    pub(crate) fn new(extent: u32) -> Self {
        Self { extent, holds_geometry: None, elements: imbl::OrdMap::new() }
    }

    /// The element, if it is defined.
    pub(crate) fn get(&self, subscript: u32) -> Option<&ArrayElement> {
        self.elements.get(&subscript)
    }

    /// Defines an element.
    pub(crate) fn set(&mut self, subscript: u32, element: ArrayElement) {
        match &element {
            ArrayElement::Scalar(_) => self.holds_geometry = Some(false),
            ArrayElement::Geometry(_) => self.holds_geometry = Some(true),
            ArrayElement::Poisoned => {}
        }
        self.elements.insert(subscript, element);
    }

    /// The defined elements in order of their subscripts.
    pub(crate) fn elements(&self) -> impl Iterator<Item = (&u32, &ArrayElement)> {
        self.elements.iter()
    }
}
