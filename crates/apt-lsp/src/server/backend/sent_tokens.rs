//! The tokens that the client has, of which later answers are differences.

use std::sync::{Arc, PoisonError};

use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::{self as lsp, Uri};

use super::Backend;
use crate::convert::tokens;

/// Encoded tokens of a document, with the id under which the client knows them.
pub(super) type SentTokens = (String, Arc<Vec<lsp::SemanticToken>>);

impl Backend {
    /// Keeps what was sent, for the differences to it.
    pub(super) fn remember_tokens(&self, uri: Uri, id: String, tokens: Arc<Vec<lsp::SemanticToken>>) {
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

    /// All tokens of a document, which are kept as sent.
    pub(super) async fn all_tokens(&self, uri: Uri) -> Result<SentTokens> {
        let (id, tokens) = self
            .ask("semantic tokens", uri.clone(), |snapshot, _| {
                let found = snapshot.document.tokens(None);
                Ok((snapshot.revision.to_string(), Arc::new(tokens::encode(&snapshot.index, &found))))
            })
            .await?;
        self.remember_tokens(uri, id.clone(), Arc::clone(&tokens));
        Ok((id, tokens))
    }
}
