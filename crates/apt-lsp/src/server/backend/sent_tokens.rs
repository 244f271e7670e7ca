//! The tokens that the client has, of which later answers are differences.

use std::sync::{Arc, PoisonError};

use serde::Serialize;
use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::{self as lsp, Uri};

use super::Backend;
use crate::convert::tokens;
use crate::server::parcels::{Ticket, packed};

/// Encoded tokens of a document, with the id under which the client knows them.
pub(super) type SentTokens = (String, Arc<Vec<lsp::SemanticToken>>);

impl Backend {
    /// Keeps what was sent, for the differences to it.
    fn remember_tokens(&self, uri: Uri, id: String, tokens: Arc<Vec<lsp::SemanticToken>>) {
        self.sent_tokens.lock().unwrap_or_else(PoisonError::into_inner).insert(uri, (id, tokens));
    }

    /// What was last sent of a document.
    pub(super) fn sent_tokens(&self, uri: &Uri) -> Option<SentTokens> {
        self.sent_tokens.lock().unwrap_or_else(PoisonError::into_inner).get(uri).cloned()
    }

    /// The document is closed.
    pub(super) fn forget_tokens(&self, uri: &Uri) {
        self.sent_tokens.lock().unwrap_or_else(PoisonError::into_inner).remove(uri);
    }

    /// An answer about all tokens of a document, which are kept as sent.
    pub(super) async fn answer_tokens<T: Serialize>(
        &self,
        uri: Uri,
        answer: impl FnOnce(String, &[lsp::SemanticToken]) -> T + Send + 'static,
    ) -> Result<Ticket> {
        let (id, tokens, packed) = self
            .ask("semantic tokens", uri.clone(), |snapshot, control| {
                let id = snapshot.revision.to_string();
                let tokens = snapshot.document.tokens(None, control)?;
                let tokens = tokens::encode(&snapshot.index, &tokens, &control.pace())?;
                let packed = packed(&answer(id.clone(), &tokens));
                Ok((id, Arc::new(tokens), packed))
            })
            .await?;
        self.remember_tokens(uri, id, tokens);
        Ok(self.parcels.put(packed?))
    }
}
