//! Requests about a whole document: their answers are made into bytes where the work is done, and sent as they are.

use serde::Serialize;
use serde_json::json;
use tower_lsp::jsonrpc::{Error, ErrorCode, Result};
use tower_lsp::ls_types::{self as lsp, Uri};

use super::{Backend, SERVER_CANCELLED, locations};
use crate::analysis::{Answer, Control, Interrupted, Level, Spot};
use crate::convert::{outgoing, tokens, written};
use crate::server::documents::Snapshot;
use crate::server::parcels::{Ticket, begun, packed};
use crate::server::{diagnostics, job};

impl Backend {
    async fn ask_whole<T: Serialize>(
        &self,
        name: &'static str,
        uri: Uri,
        work: impl FnOnce(&Snapshot, &Control) -> Answer<T> + Send + 'static,
    ) -> Result<Ticket> {
        let answer = move |snapshot: &Snapshot, control: &Control| Ok(packed(&work(snapshot, control)?));
        let packed = self.ask(name, uri, answer).await??;
        Ok(self.parcels.put(packed))
    }

    pub(in crate::server) async fn symbols(&self, params: lsp::DocumentSymbolParams) -> Result<Ticket> {
        let (uri, nested) = (params.text_document.uri, self.features().nested_symbols);
        let answer = self.ask("document symbols", uri, move |snapshot, control| {
            let (index, outline) = (&snapshot.index, snapshot.document.outline(control)?);
            let mut packed = begun();
            if nested {
                written::symbols(&mut packed, index, &outline, &control.pace())?;
            } else {
                written::value(&mut packed, &outgoing::flat_symbols(index, &snapshot.uri, outline));
            }
            Ok(packed)
        });
        Ok(self.parcels.put(answer.await?))
    }

    pub(in crate::server) async fn all_references(&self, params: lsp::ReferenceParams) -> Result<Ticket> {
        let with_definition = params.context.include_declaration;
        let place = params.text_document_position;
        self.ask_whole("references", place.text_document.uri, move |snapshot, control| {
            let file = snapshot.included_path();
            let spot = Spot { file: file.as_deref(), offset: snapshot.index.offset(place.position) };
            let mut found = snapshot.program().document.references(spot, control)?;
            found.retain(|one| with_definition || !one.occurrence.defines);
            locations(snapshot, &found, control)
        })
        .await
    }

    pub(in crate::server) async fn folds(&self, params: lsp::FoldingRangeParams) -> Result<Ticket> {
        self.ask_whole("folding ranges", params.text_document.uri, |snapshot, control| {
            let folds = snapshot.document.folds(control)?;
            let (pace, mut told) = (control.pace(), Vec::new());
            for fold in &folds {
                pace.go_on(1)?;
                told.extend(outgoing::fold(&snapshot.index, fold));
            }
            Ok(told)
        })
        .await
    }

    pub(in crate::server) async fn lenses(&self, params: lsp::CodeLensParams) -> Result<Ticket> {
        self.ask_whole("code lenses", params.text_document.uri, |snapshot, control| {
            let program = snapshot.program();
            let mut lenses = snapshot.document.lenses(control)?;
            if program.uri != snapshot.uri {
                // An included file runs with its program only.
                lenses.retain(|lens| lens.run.is_none());
            }
            let lenses = lenses.into_iter().map(|lens| outgoing::lens(&snapshot.index, &program.uri, lens));
            Ok(lenses.collect::<Vec<_>>())
        })
        .await
    }

    pub(in crate::server) async fn format(&self, params: lsp::DocumentFormattingParams) -> Result<Ticket> {
        // The style is that of the project, not of the editor: columns have a meaning in part programs.
        self.ask_whole("formatting", params.text_document.uri, |snapshot, control| {
            super::formatting_edits(snapshot, None, control)
        })
        .await
    }

    pub(in crate::server) async fn tokens(&self, params: lsp::SemanticTokensParams) -> Result<Ticket> {
        self.answer_tokens(params.text_document.uri, |id, tokens| lsp::SemanticTokens {
            result_id: Some(id),
            data: tokens.to_vec(),
        })
        .await
    }

    pub(in crate::server) async fn tokens_delta(
        &self,
        params: lsp::SemanticTokensDeltaParams,
    ) -> Result<Ticket> {
        let uri = params.text_document.uri;
        let before = self.sent_tokens(&uri).filter(|(id, _)| *id == params.previous_result_id);
        self.answer_tokens(uri, move |id, now| match before {
            Some((_, old)) => {
                let edits = tokens::difference(&old, now);
                lsp::SemanticTokensFullDeltaResult::from(lsp::SemanticTokensDelta {
                    result_id: Some(id),
                    edits,
                })
            }
            None => lsp::SemanticTokens { result_id: Some(id), data: now.to_vec() }.into(),
        })
        .await
    }

    pub(in crate::server) async fn pulled_findings(
        &self,
        params: lsp::DocumentDiagnosticParams,
    ) -> Result<Ticket> {
        let snapshot = job::snapshot(&self.events, params.text_document.uri).await?;
        let id = snapshot.revision.to_string();
        if params.previous_result_id.as_ref() == Some(&id) {
            let unchanged = lsp::UnchangedDocumentDiagnosticReport { result_id: id };
            let report = lsp::RelatedUnchangedDocumentDiagnosticReport {
                related_documents: None,
                unchanged_document_diagnostic_report: unchanged,
            };
            return Ok(self.parcels.put(packed(&lsp::DocumentDiagnosticReport::Unchanged(report))?));
        }
        let level = if diagnostics::wants_motion(&snapshot) { Level::Motion } else { Level::Section1 };
        let superseded = snapshot.superseded.clone();
        let found = job::on_snapshot("diagnostics", snapshot, move |snapshot, control| {
            let mut packed = begun();
            packed.extend_from_slice(b"{\"kind\":\"full\",\"resultId\":");
            written::value(&mut packed, &id);
            packed.extend_from_slice(b",\"items\":");
            diagnostics::write_findings(&mut packed, snapshot, level, control)?;
            packed.push(b'}');
            Ok::<_, Interrupted>(packed)
        })
        .await;
        let packed = found.map_err(|error| {
            if superseded.is_cancelled() && error.code == ErrorCode::ContentModified {
                let retrigger = json!({ "retriggerRequest": true });
                return Error {
                    code: SERVER_CANCELLED,
                    message: Interrupted.to_string().into(),
                    data: Some(retrigger),
                };
            }
            error
        })?;
        Ok(self.parcels.put(packed))
    }
}
