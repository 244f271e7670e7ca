//! Answers about whole documents, as bytes.
//!
//! The library makes a JSON value of every answer before it writes it: of a hundred thousand places that takes ten times
//! the memory of the text and most of the time. So requests whose answers grow with the document get other names on the
//! way in, under which the answer is only a ticket; on the way out the bytes that belong to the ticket take its place.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use serde::Serialize;
use tower_lsp::jsonrpc::{Error, Request, Result};

/// Requests that are answered with a ticket, with the names under which the service knows them.
pub(super) mod method {
    /// `textDocument/documentSymbol`.
    pub(crate) const SYMBOLS: &str = "apt-lsp/documentSymbol";
    /// `textDocument/references`.
    pub(crate) const REFERENCES: &str = "apt-lsp/references";
    /// `textDocument/foldingRange`.
    pub(crate) const FOLDS: &str = "apt-lsp/foldingRange";
    /// `textDocument/codeLens`.
    pub(crate) const LENSES: &str = "apt-lsp/codeLens";
    /// `textDocument/formatting`.
    pub(crate) const FORMATTING: &str = "apt-lsp/formatting";
    /// `textDocument/semanticTokens/full`.
    pub(crate) const TOKENS: &str = "apt-lsp/semanticTokens/full";
    /// `textDocument/semanticTokens/full/delta`.
    pub(crate) const TOKENS_DELTA: &str = "apt-lsp/semanticTokens/full/delta";
    /// `textDocument/diagnostic`.
    pub(crate) const DIAGNOSTIC: &str = "apt-lsp/diagnostic";

    /// All of them.
    pub(super) const ALL: [&str; 8] =
        [SYMBOLS, REFERENCES, FOLDS, LENSES, FORMATTING, TOKENS, TOKENS_DELTA, DIAGNOSTIC];
}

/// What all tickets begin with.
const MARK: &str = "apt-lsp/parcel/";

/// How a message begins whose answer is a ticket.
const ANSWER: &str = "{\"jsonrpc\":\"2.0\",\"result\":";

/// Bytes that wait for the messages of which they are the answers.
#[derive(Debug, Clone, Default)]
pub(super) struct Parcels(Arc<Mutex<Waiting>>);

#[derive(Debug, Default)]
struct Waiting {
    last: u64,
    /// Messages that lack only their end, by their tickets.
    parcels: BTreeMap<u64, Vec<u8>>,
}

/// What stands for an answer on its way through the library.
#[derive(Debug, Serialize)]
#[serde(transparent)]
pub(super) struct Ticket(String);

/// The beginning of a message, to which its answer is to be written.
pub(super) fn begun() -> Vec<u8> {
    Vec::from(ANSWER)
}

/// The beginning of a message with an answer.
pub(super) fn packed(answer: &impl Serialize) -> Result<Vec<u8>> {
    let mut bytes = begun();
    serde_json::to_writer(&mut bytes, answer)
        .map_err(|error| Error { message: error.to_string().into(), ..Error::internal_error() })?;
    Ok(bytes)
}

impl Parcels {
    /// Puts an answer aside. Its ticket is to be given away at once: nobody else takes the answer out again.
    pub(super) fn put(&self, packed: Vec<u8>) -> Ticket {
        let mut waiting = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        waiting.last += 1;
        let number = waiting.last;
        waiting.parcels.insert(number, packed);
        Ticket(format!("{MARK}{number}"))
    }

    /// A message of the service, with the answer in the place of its ticket if it has one.
    pub(super) fn filled(&self, body: Vec<u8>) -> Vec<u8> {
        let Some((number, rest)) = ticket_in(&body) else { return body };
        let mut waiting = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        match waiting.parcels.remove(&number) {
            Some(mut packed) => {
                packed.extend_from_slice(rest);
                packed
            }
            None => body,
        }
    }
}

/// The number of the ticket that is the answer of a message, and what follows it.
fn ticket_in(body: &[u8]) -> Option<(u64, &[u8])> {
    let ticket = body.strip_prefix(ANSWER.as_bytes())?.strip_prefix(b"\"")?.strip_prefix(MARK.as_bytes())?;
    let end = ticket.iter().position(|byte| *byte == b'"')?;
    let (number, rest) = (ticket.get(..end)?, ticket.get(end + 1..)?);
    Some((std::str::from_utf8(number).ok()?.parse().ok()?, rest))
}

/// A request under the name that leads to a ticket; none if it keeps its name.
pub(super) fn renamed(request: &Request) -> Option<Request> {
    let ending = request.method().strip_prefix("textDocument/")?;
    let name = method::ALL.into_iter().find(|name| name.strip_prefix("apt-lsp/") == Some(ending))?;
    let id = request.id()?.clone();
    let params = request.params()?.clone();
    Some(Request::build(name).params(params).id(id).finish())
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};
    use tower_lsp::jsonrpc::{Id, Response};

    use super::*;

    #[test]
    fn an_answer_takes_the_place_of_its_ticket_once() {
        let parcels = Parcels::default();
        let answer = json!([{ "name": "P\"1\"" }, 2.5, null]);
        let ticket = parcels.put(packed(&answer).unwrap());
        let message = |id| Response::from_ok(id, serde_json::to_value(&ticket).unwrap());
        for id in [Id::Number(-7), Id::String("a\",\"b".to_owned())] {
            let ticket = serde_json::to_vec(&message(id.clone())).unwrap();
            let number = ticket_in(&ticket).unwrap().0;
            parcels.0.lock().unwrap().parcels.insert(number, packed(&answer).unwrap());
            let filled: Value = serde_json::from_slice(&parcels.filled(ticket.clone())).unwrap();
            assert_eq!(filled, serde_json::to_value(Response::from_ok(id, answer.clone())).unwrap());
            assert_eq!(parcels.filled(ticket.clone()), ticket, "an answer is given once");
        }
        assert!(parcels.0.lock().unwrap().parcels.is_empty());
    }

    #[test]
    fn other_messages_stay_as_they_are() {
        let parcels = Parcels::default();
        let _ticket = parcels.put(packed(&1).unwrap());
        for body in [
            "{\"jsonrpc\":\"2.0\",\"result\":\"apt-lsp/parcel/9\",\"id\":1}",
            "{\"jsonrpc\":\"2.0\",\"result\":\"apt-lsp/parcel/\",\"id\":1}",
            "{\"jsonrpc\":\"2.0\",\"result\":[\"apt-lsp/parcel/1\"],\"id\":1}",
            "{\"jsonrpc\":\"2.0\",\"method\":\"a\"}",
            "",
        ] {
            assert_eq!(parcels.filled(body.as_bytes().to_vec()), body.as_bytes());
        }
    }

    #[test]
    fn only_requests_about_whole_documents_get_other_names() {
        let request = |method: &'static str| Request::build(method).params(json!({ "a": 1 }));
        let whole = renamed(&request("textDocument/semanticTokens/full").id(3).finish()).unwrap();
        assert_eq!(whole, request(method::TOKENS).id(3).finish());
        assert_eq!(renamed(&request("textDocument/semanticTokens/range").id(3).finish()), None);
        assert_eq!(renamed(&request("textDocument/hover").id(3).finish()), None);
        assert_eq!(renamed(&request("textDocument/formatting").finish()), None, "it wants no answer");
    }
}
