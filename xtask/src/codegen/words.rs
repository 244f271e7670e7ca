//! The words of the vocabulary file, by class.

use std::collections::BTreeMap;

use apt_syntax::vocabulary::{WordClass, generate::entries};

use crate::failure::{Failure, Outcome};

/// What the syntax files need of the vocabulary.
#[derive(Debug)]
pub(super) struct Vocabulary {
    words: BTreeMap<WordClass, Vec<String>>,
}

impl Vocabulary {
    /// Reads the vocabulary file.
    pub(super) fn parse(source: &str) -> Outcome<Self> {
        let entries = entries(source).map_err(|fault| Failure::Vocabulary(fault.to_string()))?;
        let mut words: BTreeMap<WordClass, Vec<String>> = BTreeMap::new();
        for entry in entries {
            words.entry(entry.class).or_default().push(entry.spelling);
        }
        for spellings in words.values_mut() {
            // Longer words first: an alternation takes the first that fits.
            spellings.sort_by(|a, b| b.len().cmp(&a.len()).then_with(|| a.cmp(b)));
        }
        Ok(Self { words })
    }

    /// The words of a class, longer ones first.
    pub(super) fn of(&self, class: WordClass) -> &[String] {
        self.words.get(&class).map_or(&[], Vec::as_slice)
    }

    /// The classes that have words, in their order.
    pub(super) fn classes(&self) -> impl Iterator<Item = WordClass> + '_ {
        self.words.keys().copied()
    }
}

#[cfg(test)]
pub(super) const SAMPLE: &str = r#"
[[word]]
spelling = "PARTNO"
class = "text"
status = "parsed"
help = "x"
[[word]]
spelling = "GO"
class = "motion"
status = "parsed"
help = "x"
[[word]]
spelling = "GOLFT"
class = "motion"
status = "parsed"
help = "x"
[[word]]
spelling = "END-OF-PATH"
class = "postprocessor-bare"
status = "parsed"
help = "x"
[[word]]
spelling = "3PT2SL"
class = "minor"
status = "parsed"
help = "x"
"#;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn longer_words_come_first() {
        let vocabulary = Vocabulary::parse(SAMPLE).expect("the sample is valid");
        assert_eq!(vocabulary.of(WordClass::Motion), ["GOLFT", "GO"]);
        assert!(vocabulary.of(WordClass::Logic).is_empty());
    }

    #[test]
    fn a_word_without_a_class_is_a_fault() {
        let fault = Vocabulary::parse("[[word]]\nspelling = \"GO\"\n");
        assert!(matches!(fault, Err(Failure::Vocabulary(message)) if message.contains("class")));
    }
}
