//! Long lists. One that grows as a whole is copied as a whole now and then, and one that is put in order as a whole takes its time, which
//! nobody can interrupt.

use std::{cmp::Ordering, fmt};

use crate::patience::{Patience, put_away};

/// Things of a piece: such of hundred bytes are copied in some ten microseconds.
const PIECE: usize = 4096;

/// Things that are counted as one unit of work where they are copied.
const THINGS_A_UNIT: usize = 16;

/// Bytes of a page of text, which are copied in some microseconds.
const PAGE: usize = 1 << 16;

/// Bytes of text that are counted as one unit of work where they are copied.
const BYTES_A_UNIT: usize = 1 << 12;

/// Things that are put in order without a question, in some ten microseconds.
const RUN: usize = 256;

/// A list in an order, found in pieces that are put in order and then merged, between which is asked; things that are alike stay in
/// the order that they have. As far as it is found where who waits gives up before the end.
pub fn sorted<T>(list: Vec<T>, order: impl Fn(&T, &T) -> Ordering, patience: Patience<'_>) -> Vec<T> {
    let mut runs = Vec::new();
    let mut list = list.into_iter();
    loop {
        let mut run: Vec<T> = list.by_ref().take(RUN).collect();
        if run.is_empty() || patience.ends_after(run.len() as u32) {
            break;
        }
        run.sort_by(&order);
        runs.push(run);
    }
    while runs.len() > 1 {
        let mut shorter = runs.into_iter();
        let mut longer = Vec::new();
        while let Some(first) = shorter.next() {
            longer.push(match shorter.next() {
                Some(second) => merged(first, second, &order, patience),
                None => first,
            });
        }
        runs = longer;
    }
    runs.pop().unwrap_or_default()
}

/// Two lists in an order as one.
fn merged<T>(
    first: Vec<T>,
    second: Vec<T>,
    order: impl Fn(&T, &T) -> Ordering,
    patience: Patience<'_>,
) -> Vec<T> {
    let mut all = Vec::with_capacity(first.len() + second.len());
    let (mut first, mut second) = (first.into_iter().peekable(), second.into_iter().peekable());
    while !patience.ends_among(all.len(), THINGS_A_UNIT) {
        let next = match (first.peek(), second.peek()) {
            (Some(one), Some(other)) if order(one, other).is_gt() => second.next(),
            (Some(_), _) => first.next(),
            (None, _) => second.next(),
        };
        let Some(next) = next else { break };
        all.push(next);
    }
    all
}

/// A list in pieces, none of which is ever copied to make room.
#[derive(Debug, Clone)]
pub struct Pieces<T> {
    full: Vec<Vec<T>>,
    last: Vec<T>,
}

impl<T> Default for Pieces<T> {
    fn default() -> Self {
        Self { full: Vec::new(), last: Vec::new() }
    }
}

impl<T> Pieces<T> {
    /// Puts a thing behind the others.
    pub fn push(&mut self, thing: T) {
        if self.last.len() == PIECE {
            self.full.push(std::mem::replace(&mut self.last, Vec::with_capacity(PIECE)));
        }
        self.last.push(thing);
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.full.len() * PIECE + self.last.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.last.is_empty()
    }

    /// One of them, counted from zero.
    pub fn get(&self, index: usize) -> Option<&T> {
        match index.checked_sub(self.full.len() * PIECE) {
            Some(in_last) => self.last.get(in_last),
            None => self.full.get(index / PIECE)?.get(index % PIECE),
        }
    }

    /// The same, to be changed.
    pub fn get_mut(&mut self, index: usize) -> Option<&mut T> {
        match index.checked_sub(self.full.len() * PIECE) {
            Some(in_last) => self.last.get_mut(in_last),
            None => self.full.get_mut(index / PIECE)?.get_mut(index % PIECE),
        }
    }

    /// All of them in order.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = &T> {
        self.full.iter().flatten().chain(&self.last)
    }

    /// The same, to be changed.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut T> {
        self.full.iter_mut().flatten().chain(&mut self.last)
    }

    /// Leaves at most so many of them, the first.
    pub fn truncate(&mut self, most: usize) {
        if most >= self.len() {
            return;
        }
        let (pieces, rest) = (most / PIECE, most % PIECE);
        if pieces < self.full.len() {
            self.full.truncate(pieces + 1);
            self.last = self.full.pop().unwrap_or_default();
        }
        self.last.truncate(rest);
    }

    /// The last one.
    pub fn last(&self) -> Option<&T> {
        self.last.last()
    }

    /// The same, to be changed.
    pub fn last_mut(&mut self) -> Option<&mut T> {
        self.last.last_mut()
    }

    /// All as one list; as far as they are put together where who waits gives up before the end.
    pub fn joined(self, patience: Patience<'_>) -> Vec<T>
    where
        T: Send + 'static,
    {
        if self.full.is_empty() { self.last } else { self.joined_as(|thing| thing, patience) }
    }

    /// The same of what is made of each.
    pub fn joined_as<U>(self, mut make: impl FnMut(T) -> U, patience: Patience<'_>) -> Vec<U>
    where
        T: Send + 'static,
    {
        let count = self.len();
        let mut all = Vec::with_capacity(count);
        let mut pieces = self.full;
        pieces.push(self.last);
        for piece in &mut pieces {
            if patience.ends_after((PIECE / THINGS_A_UNIT) as u32) {
                break;
            }
            all.extend(piece.drain(..).map(&mut make));
        }
        // Their memory goes back to the system at once where the last one is given back, which takes its time.
        put_away(pieces, count);
        all
    }
}

/// A list and another one behind it, moved in pieces, between which is asked; as far as they are moved where who waits gives up before the
/// end. Where one of them is empty nothing is moved.
pub fn followed<T: Send + 'static>(first: Vec<T>, second: Vec<T>, patience: Patience<'_>) -> Vec<T> {
    match (first.is_empty(), second.is_empty()) {
        (true, _) => second,
        (_, true) => first,
        (false, false) => {
            let count = first.len() + second.len();
            let mut all = Vec::with_capacity(count);
            let mut lists = [first, second].map(Vec::into_iter);
            for list in &mut lists {
                while !list.as_slice().is_empty() && !patience.ends_after((PIECE / THINGS_A_UNIT) as u32) {
                    all.extend(list.take(PIECE));
                }
            }
            put_away(lists, count);
            all
        }
    }
}

/// A text in pages, none of which is ever copied to make room.
#[derive(Debug, Default)]
pub struct Pages {
    full: Vec<String>,
    last: String,
}

impl Pages {
    /// All as one text; as far as it is put together where who waits gives up before the end.
    pub fn joined(self, patience: Patience<'_>) -> String {
        if self.full.is_empty() {
            return self.last;
        }
        let bytes = self.full.iter().map(String::len).sum::<usize>() + self.last.len();
        let mut all = String::with_capacity(bytes);
        for page in self.full.iter().chain([&self.last]) {
            if patience.ends_after((PAGE / BYTES_A_UNIT) as u32) {
                break;
            }
            all.push_str(page);
        }
        all
    }
}

impl fmt::Write for Pages {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        if self.last.len() + text.len() > PAGE && !self.last.is_empty() {
            self.full.push(std::mem::replace(&mut self.last, String::with_capacity(PAGE)));
        }
        self.last.push_str(text);
        Ok(())
    }
}

impl<T> IntoIterator for Pieces<T> {
    type Item = T;
    type IntoIter = std::iter::Flatten<std::vec::IntoIter<Vec<T>>>;

    /// All of them in order; a piece is given back when it has been gone through.
    fn into_iter(self) -> Self::IntoIter {
        let mut pieces = self.full;
        pieces.push(self.last);
        pieces.into_iter().flatten()
    }
}

impl<T> FromIterator<T> for Pieces<T> {
    fn from_iter<I: IntoIterator<Item = T>>(things: I) -> Self {
        let mut pieces = Self::default();
        pieces.extend(things);
        pieces
    }
}

impl<T> Extend<T> for Pieces<T> {
    fn extend<I: IntoIterator<Item = T>>(&mut self, things: I) {
        things.into_iter().for_each(|thing| self.push(thing));
    }
}

#[cfg(test)]
mod tests {
    use std::{cell::Cell, fmt::Write as _};

    use super::*;
    use crate::patience::Waiting;

    #[test]
    fn pieces_are_one_list_and_are_put_together_with_questions() {
        for count in [0, 1, PIECE, PIECE + 1, 3 * PIECE + 7] {
            let mut pieces = Pieces::default();
            pieces.extend(0..count);
            assert_eq!((pieces.len(), pieces.is_empty()), (count, count == 0));
            assert_eq!(pieces.last().copied(), count.checked_sub(1));
            for index in [0, PIECE - 1, PIECE, count.saturating_sub(1)] {
                let there = (index < count).then_some(index);
                assert_eq!(pieces.get_mut(index).copied(), there, "{index} of {count}");
            }
            assert!(pieces.get(count).is_none() && pieces.get_mut(count).is_none());
            assert!(pieces.iter().copied().eq(0..count) && pieces.clone().into_iter().eq(0..count));
            assert!(pieces.iter().rev().copied().eq((0..count).rev()));
            for most in [0, 1, PIECE - 1, PIECE, PIECE + 1, 2 * PIECE, count] {
                let mut fewer = pieces.clone();
                fewer.truncate(most);
                fewer.push(7);
                fewer.iter_mut().for_each(|thing| *thing += 1);
                assert!(fewer.iter().copied().eq((1..=count.min(most)).chain([8])), "{most} of {count}");
            }
            assert_eq!(pieces.joined(Patience::default()), (0..count).collect::<Vec<_>>());
        }
        let asked = Cell::new(0);
        let ask = || {
            asked.set(asked.get() + 1);
            asked.get() == 2
        };
        let waiting = Waiting::until(&ask);
        let mut pieces = Pieces::default();
        pieces.extend(0..3 * PIECE);
        assert_eq!(pieces.joined(waiting.patience()).len(), PIECE);
        assert_eq!(asked.get(), 2);
    }

    #[test]
    fn pages_are_one_text_and_are_put_together_with_questions() {
        let words = ["", "seven\n", "a word of more than one byte: \u{e9}\u{e9}", "\n"];
        for count in [0, 1, PAGE / 8, PAGE] {
            let (mut pages, mut known) = (Pages::default(), String::new());
            for at in 0..count {
                pages.write_str(words[at % words.len()]).unwrap();
                known.push_str(words[at % words.len()]);
            }
            assert_eq!(pages.joined(Patience::default()), known);
        }
        let long = "x".repeat(3 * PAGE);
        let mut pages = Pages::default();
        for text in ["first", &long, "last"] {
            pages.write_str(text).unwrap();
        }
        assert_eq!(pages.joined(Patience::default()), format!("first{long}last"));
        let asked = Cell::new(0);
        let ask = || {
            asked.set(asked.get() + 1);
            asked.get() == 2
        };
        let waiting = Waiting::until(&ask);
        let mut pages = Pages::default();
        for _ in 0..100 {
            pages.write_str(&"y".repeat(PAGE)).unwrap();
        }
        let text = pages.joined(waiting.patience());
        assert!(text.len() < 100 * PAGE && asked.get() == 2, "{} bytes, asked {}", text.len(), asked.get());
    }

    #[test]
    fn a_list_behind_another_one_is_moved_with_questions() {
        for (first, second) in [(0, 0), (0, 7), (7, 0), (3, 4), (PIECE, PIECE + 1), (2 * PIECE + 5, 1)] {
            let all = followed((0..first).collect(), (first..first + second).collect(), Patience::default());
            assert!(all.into_iter().eq(0..first + second), "{first} and {second}");
        }
        let asked = Cell::new(0);
        let ask = || {
            asked.set(asked.get() + 1);
            asked.get() == 3
        };
        let waiting = Waiting::until(&ask);
        let all = followed(vec![0; 2 * PIECE], vec![1; 2 * PIECE], waiting.patience());
        assert_eq!((all.len(), asked.get()), (2 * PIECE, 3), "two pieces, and none of the second list");
    }

    #[test]
    fn a_list_is_put_in_order_with_questions_and_what_is_alike_keeps_its_order() {
        let list: Vec<(usize, usize)> = (0..10 * RUN + 7).map(|at| (at * 7_919 % 1_000, at)).collect();
        let order = |one: &(usize, usize), other: &(usize, usize)| one.0.cmp(&other.0);
        let asked = Cell::new(0);
        let ask = || {
            asked.set(asked.get() + 1);
            false
        };
        let waiting = Waiting::until(&ask);
        let mut known = list.clone();
        known.sort_by(order);
        assert_eq!(sorted(list, order, waiting.patience()), known);
        assert!(asked.get() >= 10, "{}", asked.get());
        assert_eq!(sorted(Vec::<usize>::new(), Ord::cmp, Patience::default()), []);
    }
}
