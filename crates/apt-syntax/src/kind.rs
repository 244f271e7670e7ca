//! The kinds of tokens and nodes of the tree.

/// Makes the enumeration of kinds, that of the kinds of elements, which are some of them, and the table of all of them,
/// which is at the index of their number, from one list.
macro_rules! syntax_kinds {
    (
        trivia { $($(#[$trivia_doc:meta])* $trivia:ident,)* }
        elements { $($(#[$element_doc:meta])* $element:ident,)* }
        others { $($(#[$doc:meta])* $kind:ident,)* }
    ) => {
        /// What a token or node is.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(u16)]
        pub enum SyntaxKind {
            $($(#[$trivia_doc])* $trivia,)*
            $($(#[$element_doc])* $element,)*
            $($(#[$doc])* $kind,)*
        }

        /// The kind of an element of a statement.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum ElementKind {
            $($(#[$element_doc])* $element,)*
        }

        impl From<ElementKind> for SyntaxKind {
            /// The kind of token in which an element is written.
            fn from(kind: ElementKind) -> SyntaxKind {
                match kind {
                    $(ElementKind::$element => SyntaxKind::$element,)*
                }
            }
        }

        /// All kinds, at the index of their number.
        const ALL: &[SyntaxKind] = &[
            $(SyntaxKind::$trivia,)*
            $(SyntaxKind::$element,)*
            $(SyntaxKind::$kind,)*
        ];
    };
}

syntax_kinds! {
    // Tokens without meaning for the statement.
    trivia {
        /// Blanks and tabs.
        Whitespace,
        /// A line end.
        LineEnd,
        /// `$$` and what follows, or the commentary after a continuation sign.
        Comment,
        /// The `$` that continues the statement on the next record.
        Continuation,
        /// Columns 73 and later of a card.
        SequenceField,
    }
    elements {
        /// A name.
        Name,
        /// A vocabulary word.
        Word,
        /// A number.
        Number,
        /// `,`
        Comma,
        /// `/`
        Slash,
        /// `=`
        Equals,
        /// `(`
        LeftParenthesis,
        /// `)`
        RightParenthesis,
        /// `+`
        Plus,
        /// `-`
        Minus,
        /// `*`
        Star,
        /// `**`
        Power,
        /// The text of a text statement, or quoted text.
        Text,
        /// `.EQ.` and the like.
        Relation,
        /// A character outside the set, or a malformed number.
        Bad,
    }
    others {
        /// `;` between two statements.
        Semicolon,
        // Nodes.
        /// The whole document.
        Root,
        /// One statement with its line end.
        Statement,
        /// An element that is written in several pieces.
        Split,
        /// `label)`.
        Label,
        /// PARTNO and its kin.
        TextStatement,
        /// `A=3`.
        Assignment,
        /// `P=POINT/…`.
        Definition,
        /// `M=MACRO/…`.
        MacroHeader,
        /// A macro variable with its value.
        MacroParameter,
        /// `CALL/…`.
        Call,
        /// `IF(…)…`.
        If,
        /// `DO/…`.
        Do,
        /// `JUMPTO/…`.
        Jump,
        /// Any other major word.
        Major,
        /// `OBTAIN,…`.
        Obtain,
        /// `TYPE/…`.
        DefinitionBody,
        /// A list of parameters.
        ParameterList,
        /// `(POINT/…)`.
        Nested,
        /// `(1,2)`.
        NestedPoint,
        /// `A(1,THRU,3)`.
        Inclusive,
        /// A name with its subscript.
        Reference,
        /// A parenthesised subscript.
        Subscript,
        /// A sign with its operand.
        Signed,
        /// Operands and the operators between them: of one rank, or a power.
        Binary,
        /// A function with its arguments.
        FunctionCall,
        /// `(e)`.
        Parenthesised,
        /// `(A=e)`.
        NestedAssignment,
        /// A logical condition.
        Condition,
        /// What could not be read.
        Error,
    }
}

impl SyntaxKind {
    /// Whether a token of this kind means nothing to the statement.
    pub fn is_trivia(self) -> bool {
        self <= SyntaxKind::SequenceField || self == SyntaxKind::Semicolon
    }
}

/// The language of rowan trees.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Apt {}

impl rowan::Language for Apt {
    type Kind = SyntaxKind;

    fn kind_from_raw(raw: rowan::SyntaxKind) -> SyntaxKind {
        ALL.get(usize::from(raw.0)).copied().unwrap_or(SyntaxKind::Error)
    }

    fn kind_to_raw(kind: SyntaxKind) -> rowan::SyntaxKind {
        rowan::SyntaxKind(kind as u16)
    }
}

/// A node of the lossless tree.
pub type SyntaxNode = rowan::SyntaxNode<Apt>;
/// A token of the lossless tree.
pub type SyntaxToken = rowan::SyntaxToken<Apt>;

#[cfg(test)]
mod tests {
    use rowan::Language as _;

    use super::*;

    #[test]
    fn numbers_and_kinds_agree() {
        for (number, kind) in ALL.iter().enumerate() {
            assert_eq!(*kind as usize, number);
            assert_eq!(Apt::kind_from_raw(Apt::kind_to_raw(*kind)), *kind);
        }
        assert_eq!(Apt::kind_from_raw(rowan::SyntaxKind(9999)), SyntaxKind::Error);
    }
}
