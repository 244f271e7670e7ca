//! Programs from files and standard input.

use std::io::Read as _;
use std::path::Path;

/// The text of a program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Source {
    /// The text, without a byte-order mark.
    pub text: String,
    /// False if the bytes were no UTF-8; each byte is a character of Latin-1 then.
    pub utf8: bool,
}

/// Reads a file.
pub(crate) fn read_file(path: &Path) -> std::io::Result<Source> {
    std::fs::read(path).map(decode)
}

/// The bytes of standard input, to its end.
pub(crate) fn read_standard_input() -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    std::io::stdin().lock().read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Any bytes are a program: what is no UTF-8 comes from the time before it.
pub(crate) fn decode(bytes: Vec<u8>) -> Source {
    const BYTE_ORDER_MARK: char = '\u{feff}';
    match String::from_utf8(bytes) {
        Ok(text) => match text.strip_prefix(BYTE_ORDER_MARK) {
            Some(rest) => Source { text: rest.to_owned(), utf8: true },
            None => Source { text, utf8: true },
        },
        Err(error) => Source { text: error.into_bytes().into_iter().map(char::from).collect(), utf8: false },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_bytes_are_a_program() {
        let text = |bytes: &[u8]| decode(bytes.to_vec());
        assert_eq!(text("é".as_bytes()), Source { text: "é".into(), utf8: true });
        assert_eq!(text(b"\xef\xbb\xbfPARTNO"), Source { text: "PARTNO".into(), utf8: true });
        assert_eq!(text(b"\xe9\0"), Source { text: "é\0".into(), utf8: false });
    }
}
