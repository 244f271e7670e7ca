//! Templates of blocks: words with placeholders.

/// A piece of a template word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Piece<'a> {
    /// As it stands.
    Literal(&'a str),
    /// A placeholder.
    Placeholder {
        /// Its name.
        name: &'a str,
        /// Written with `!`.
        force: bool,
    },
}

/// Splits a word of a template.
pub(crate) fn pieces(word: &str) -> Vec<Piece<'_>> {
    let mut found = Vec::new();
    let mut rest = word;
    while let Some(open) = rest.find('{') {
        let Some(length) = rest[open..].find('}') else { break };
        if open > 0 {
            found.push(Piece::Literal(&rest[..open]));
        }
        let name = &rest[open + 1..open + length];
        let bare = name.strip_prefix('!');
        found.push(Piece::Placeholder { name: bare.unwrap_or(name), force: bare.is_some() });
        rest = &rest[open + length + 1..];
    }
    if !rest.is_empty() {
        found.push(Piece::Literal(rest));
    }
    found
}

/// The registers that a template names: placeholders of one or two capitals.
pub(crate) fn register_names(template: &str) -> Vec<String> {
    let named = template.split_whitespace().flat_map(pieces).filter_map(|piece| match piece {
        Piece::Placeholder { name, .. }
            if name.len() <= 2 && name.bytes().all(|byte| byte.is_ascii_uppercase()) =>
        {
            Some(name.to_owned())
        }
        _ => None,
    });
    named.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_split() {
        assert_eq!(
            pieces("O{prog}({!X})"),
            vec![
                Piece::Literal("O"),
                Piece::Placeholder { name: "prog", force: false },
                Piece::Literal("("),
                Piece::Placeholder { name: "X", force: true },
                Piece::Literal(")"),
            ]
        );
        assert_eq!(pieces("{open"), vec![Piece::Literal("{open")]);
        assert_eq!(register_names("{RET} G81 {X} {!ZR} {text}"), ["X", "ZR"]);
    }
}
