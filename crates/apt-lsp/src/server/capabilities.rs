//! What the server says it can do. Each entry has a test that asks for it over the wire.

use tower_lsp::ls_types::{self as lsp, ClientCapabilities, ServerCapabilities};

use crate::analysis::ActionKind;
use crate::convert::{Encoding, tokens};

/// The commands of `workspace/executeCommand`.
pub(super) const COMMANDS: [&str; 7] = [
    "apt.runMotion",
    "apt.expand",
    "apt.canonicalForm",
    "apt.post",
    "apt.syntaxTree",
    "apt.machines",
    "apt.status",
];

/// What we need to know about the client.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct ClientFeatures {
    /// How positions count.
    pub encoding: Encoding,
    /// Asks for findings itself.
    pub pulls: bool,
    /// Can be told to ask again.
    pub refresh: bool,
    /// Knows nested outlines.
    pub nested_symbols: bool,
    /// Knows snippets: completions with places to fill in.
    pub snippets: bool,
    /// Reads parameters of signatures as places in their label.
    pub label_offsets: bool,
    /// Takes actions with their edits.
    pub actions: bool,
    /// Checks the version of a text before it applies edits.
    pub versioned_edits: bool,
    /// Asks whether a name can be renamed before asking for the new one.
    pub prepares_rename: bool,
    /// Shows progress that the server begins.
    pub progress: bool,
    /// Can be asked for settings.
    pub configuration: bool,
    /// Can watch files for us.
    pub watches_files: bool,
}

impl ClientFeatures {
    /// Reads them from what the client said.
    pub(super) fn of(client: &ClientCapabilities) -> Self {
        let document = client.text_document.as_ref();
        let workspace = client.workspace.as_ref();
        let encodings = client.general.as_ref().and_then(|general| general.position_encodings.as_deref());
        Self {
            encoding: Encoding::negotiate(encodings),
            pulls: document.is_some_and(|document| document.diagnostic.is_some()),
            refresh: workspace
                .and_then(|workspace| workspace.diagnostics.as_ref())
                .and_then(|diagnostics| diagnostics.refresh_support)
                .unwrap_or(false),
            nested_symbols: document
                .and_then(|document| document.document_symbol.as_ref())
                .and_then(|symbols| symbols.hierarchical_document_symbol_support)
                .unwrap_or(false),
            snippets: document
                .and_then(|document| document.completion.as_ref())
                .and_then(|completion| completion.completion_item.as_ref())
                .and_then(|item| item.snippet_support)
                .unwrap_or(false),
            label_offsets: document
                .and_then(|document| document.signature_help.as_ref())
                .and_then(|help| help.signature_information.as_ref())
                .and_then(|signature| signature.parameter_information.as_ref())
                .and_then(|parameter| parameter.label_offset_support)
                .unwrap_or(false),
            actions: document
                .and_then(|document| document.code_action.as_ref())
                .is_some_and(|action| action.code_action_literal_support.is_some()),
            versioned_edits: workspace
                .and_then(|workspace| workspace.workspace_edit.as_ref())
                .and_then(|edit| edit.document_changes)
                .unwrap_or(false),
            prepares_rename: document
                .and_then(|document| document.rename.as_ref())
                .and_then(|rename| rename.prepare_support)
                .unwrap_or(false),
            progress: client.window.as_ref().and_then(|window| window.work_done_progress).unwrap_or(false),
            configuration: workspace.and_then(|workspace| workspace.configuration).unwrap_or(false),
            watches_files: workspace
                .and_then(|workspace| workspace.did_change_watched_files.as_ref())
                .and_then(|watch| watch.dynamic_registration)
                .unwrap_or(false),
        }
    }
}

/// What the server can do for such a client.
pub(super) fn server_capabilities(client: &ClientFeatures) -> ServerCapabilities {
    ServerCapabilities {
        position_encoding: Some(client.encoding.kind()),
        text_document_sync: Some(lsp::TextDocumentSyncCapability::Options(lsp::TextDocumentSyncOptions {
            open_close: Some(true),
            change: Some(lsp::TextDocumentSyncKind::INCREMENTAL),
            ..lsp::TextDocumentSyncOptions::default()
        })),
        hover_provider: Some(lsp::HoverProviderCapability::Simple(true)),
        completion_provider: Some(lsp::CompletionOptions {
            trigger_characters: Some(["/", ",", "="].map(str::to_owned).to_vec()),
            ..lsp::CompletionOptions::default()
        }),
        signature_help_provider: Some(lsp::SignatureHelpOptions {
            trigger_characters: Some(["/", ",", "("].map(str::to_owned).to_vec()),
            retrigger_characters: None,
            work_done_progress_options: lsp::WorkDoneProgressOptions::default(),
        }),
        declaration_provider: Some(lsp::DeclarationCapability::Simple(true)),
        definition_provider: Some(lsp::OneOf::Left(true)),
        references_provider: Some(lsp::OneOf::Left(true)),
        rename_provider: Some(if client.prepares_rename {
            lsp::OneOf::Right(lsp::RenameOptions {
                prepare_provider: Some(true),
                work_done_progress_options: lsp::WorkDoneProgressOptions::default(),
            })
        } else {
            lsp::OneOf::Left(true)
        }),
        document_highlight_provider: Some(lsp::OneOf::Left(true)),
        document_symbol_provider: Some(lsp::OneOf::Left(true)),
        workspace_symbol_provider: Some(lsp::OneOf::Left(true)),
        selection_range_provider: Some(lsp::SelectionRangeProviderCapability::Simple(true)),
        inlay_hint_provider: Some(lsp::OneOf::Left(true)),
        document_link_provider: Some(lsp::DocumentLinkOptions {
            resolve_provider: None,
            work_done_progress_options: lsp::WorkDoneProgressOptions::default(),
        }),
        // Clients without literals could only be given commands, and ours have no edits to apply.
        code_action_provider: client.actions.then(|| {
            lsp::CodeActionProviderCapability::Options(lsp::CodeActionOptions {
                code_action_kinds: Some(
                    ActionKind::ALL.map(|kind| lsp::CodeActionKind::new(kind.name())).to_vec(),
                ),
                ..lsp::CodeActionOptions::default()
            })
        }),
        document_formatting_provider: Some(lsp::OneOf::Left(true)),
        document_range_formatting_provider: Some(lsp::OneOf::Left(true)),
        call_hierarchy_provider: Some(lsp::CallHierarchyServerCapability::Simple(true)),
        folding_range_provider: Some(lsp::FoldingRangeProviderCapability::Simple(true)),
        code_lens_provider: Some(lsp::CodeLensOptions { resolve_provider: None }),
        semantic_tokens_provider: Some(
            lsp::SemanticTokensOptions {
                legend: tokens::legend(),
                range: Some(true),
                full: Some(lsp::SemanticTokensFullOptions::Delta { delta: Some(true) }),
                ..lsp::SemanticTokensOptions::default()
            }
            .into(),
        ),
        diagnostic_provider: client.pulls.then(|| {
            lsp::DiagnosticServerCapabilities::Options(lsp::DiagnosticOptions {
                identifier: Some("apt".to_owned()),
                inter_file_dependencies: true,
                workspace_diagnostics: false,
                work_done_progress_options: lsp::WorkDoneProgressOptions::default(),
            })
        }),
        execute_command_provider: Some(lsp::ExecuteCommandOptions {
            commands: COMMANDS.map(str::to_owned).to_vec(),
            work_done_progress_options: lsp::WorkDoneProgressOptions { work_done_progress: Some(true) },
        }),
        ..ServerCapabilities::default()
    }
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use super::*;

    fn features(client: serde_json::Value) -> ClientFeatures {
        ClientFeatures::of(&serde_json::from_value(client).unwrap())
    }

    #[test]
    fn a_poor_client_gets_what_every_client_understands() {
        let client = features(serde_json::json!({}));
        assert_eq!(client, ClientFeatures::default());
        let announced = serde_json::to_string_pretty(&server_capabilities(&client)).unwrap();
        expect![[r#"
            {
              "positionEncoding": "utf-16",
              "textDocumentSync": {
                "openClose": true,
                "change": 2
              },
              "selectionRangeProvider": true,
              "hoverProvider": true,
              "completionProvider": {
                "triggerCharacters": [
                  "/",
                  ",",
                  "="
                ]
              },
              "signatureHelpProvider": {
                "triggerCharacters": [
                  "/",
                  ",",
                  "("
                ]
              },
              "definitionProvider": true,
              "referencesProvider": true,
              "documentHighlightProvider": true,
              "documentSymbolProvider": true,
              "workspaceSymbolProvider": true,
              "codeLensProvider": {},
              "documentFormattingProvider": true,
              "documentRangeFormattingProvider": true,
              "renameProvider": true,
              "documentLinkProvider": {},
              "foldingRangeProvider": true,
              "declarationProvider": true,
              "executeCommandProvider": {
                "commands": [
                  "apt.runMotion",
                  "apt.expand",
                  "apt.canonicalForm",
                  "apt.post",
                  "apt.syntaxTree",
                  "apt.machines",
                  "apt.status"
                ],
                "workDoneProgress": true
              },
              "callHierarchyProvider": true,
              "semanticTokensProvider": {
                "legend": {
                  "tokenTypes": [
                    "keyword",
                    "modifier",
                    "type",
                    "function",
                    "event",
                    "macro",
                    "parameter",
                    "variable",
                    "label",
                    "number",
                    "string",
                    "operator",
                    "comment"
                  ],
                  "tokenModifiers": [
                    "definition"
                  ]
                },
                "range": true,
                "full": {
                  "delta": true
                }
              },
              "inlayHintProvider": true
            }"#]]
        .assert_eq(&announced);
    }

    #[test]
    fn a_rich_client_pulls_and_counts_bytes() {
        let client = features(serde_json::json!({
            "general": { "positionEncodings": ["utf-16", "utf-8"] },
            "textDocument": {
                "diagnostic": {},
                "completion": { "completionItem": { "snippetSupport": true } },
                "signatureHelp": {
                    "signatureInformation": { "parameterInformation": { "labelOffsetSupport": true } }
                },
                "documentSymbol": { "hierarchicalDocumentSymbolSupport": true },
                "rename": { "prepareSupport": true },
                "codeAction": { "codeActionLiteralSupport": { "codeActionKind": { "valueSet": ["quickfix"] } } },
            },
            "window": { "workDoneProgress": true },
            "workspace": {
                "configuration": true,
                "workspaceEdit": { "documentChanges": true },
                "diagnostics": { "refreshSupport": true },
                "didChangeWatchedFiles": { "dynamicRegistration": true },
            },
        }));
        assert_eq!(
            client,
            ClientFeatures {
                encoding: Encoding::Utf8,
                pulls: true,
                refresh: true,
                nested_symbols: true,
                snippets: true,
                label_offsets: true,
                actions: true,
                versioned_edits: true,
                prepares_rename: true,
                progress: true,
                configuration: true,
                watches_files: true,
            }
        );
        let announced = serde_json::to_value(server_capabilities(&client)).unwrap();
        assert_eq!(announced["positionEncoding"], "utf-8");
        assert_eq!(announced["diagnosticProvider"]["identifier"], "apt");
        let kinds = serde_json::json!([
            "quickfix",
            "source.fixAll.apt",
            "refactor.inline",
            "refactor.rewrite.renumber"
        ]);
        assert_eq!(announced["codeActionProvider"]["codeActionKinds"], kinds);
    }
}
