//! Where INCLUD finds its files: beside the program, then in the folders of the settings. What an editor holds open
//! counts in place of what stands on the disk.

use std::{
    collections::BTreeMap,
    fmt, fs, io,
    path::{Component, Path, PathBuf},
    sync::{Arc, Mutex, MutexGuard, PoisonError},
    time::SystemTime,
};

use apt_cldata::text::ClDialect;
use apt_program::{IncludeFailure, IncludeResolver, SourceFile};
use apt_syntax::{
    SyntaxTree,
    dialect::{Dialect, DialectName},
};
use smol_str::{SmolStr, format_smolstr};

/// Endings that are tried when a name has none. Names of part programs have no dots.
const ENDINGS: [&str; 3] = ["", ".apt", ".inc"];
/// Largest file that is taken, bytes; far above any part program, far below what would fill the memory.
const LARGEST_FILE: u64 = 64 << 20;
/// Parsed files that are kept; a program that includes more reads the rest again at every evaluation.
const MOST_KEPT_FILES: usize = 256;

/// Gives the present text of a file that is open in an editor.
pub type OpenText = Arc<dyn Fn() -> String + Send + Sync>;

/// The files that programs include: those open in an editor, and what was read of the others. Clones share it.
#[derive(Clone, Default)]
pub struct Files(Arc<Mutex<FilesState>>);

#[derive(Default)]
struct FilesState {
    open: BTreeMap<PathBuf, OpenFile>,
    read: BTreeMap<(PathBuf, DialectKey), (Stamp, Arc<SourceFile>)>,
}

struct OpenFile {
    text: OpenText,
    parsed: Vec<(DialectName, Arc<SourceFile>)>,
}

/// The order of dialects is of no interest, but that they have one.
type DialectKey = u8;

/// What a file on the disk was when it was read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Stamp {
    changed: Option<SystemTime>,
    length: u64,
}

impl fmt::Debug for Files {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let open: Vec<PathBuf> = self.state().open.keys().cloned().collect();
        formatter.debug_struct("Files").field("open", &open).finish_non_exhaustive()
    }
}

impl Files {
    /// From now on the text of this file is what an editor says.
    pub fn open(&self, path: &Path, text: OpenText) {
        self.state().open.insert(normalised(path), OpenFile { text, parsed: Vec::new() });
    }

    /// From now on the text of this file is again what stands on the disk.
    pub fn close(&self, path: &Path) {
        self.state().open.remove(&normalised(path));
    }

    fn state(&self) -> MutexGuard<'_, FilesState> {
        // Each change is one insertion or removal, so that a panic elsewhere leaves nothing half done.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether there is such a file, and that it is not too large.
    fn is_file(&self, path: &Path) -> bool {
        self.state().open.contains_key(path) || fs::metadata(path).is_ok_and(|found| found.is_file())
    }

    /// The file, parsed in a dialect.
    fn source(&self, path: &Path, dialect: Dialect) -> Result<Arc<SourceFile>, IncludeFailure> {
        let mut state = self.state();
        if let Some(file) = state.open.get_mut(path) {
            if let Some((_, source)) = file.parsed.iter().find(|(name, _)| *name == dialect.name) {
                return Ok(Arc::clone(source));
            }
            let source = parsed(path, &(file.text)(), dialect);
            file.parsed.push((dialect.name, Arc::clone(&source)));
            return Ok(source);
        }
        let failure = |error: io::Error| IncludeFailure::Unreadable {
            path: shown(path),
            reason: format_smolstr!("{error}"),
        };
        let found = fs::metadata(path).map_err(failure)?;
        if found.len() > LARGEST_FILE {
            return Err(IncludeFailure::TooLarge { path: shown(path), limit: LARGEST_FILE });
        }
        let stamp = Stamp { changed: found.modified().ok(), length: found.len() };
        let key = (path.to_owned(), dialect.name as DialectKey);
        if let Some((known, source)) = state.read.get(&key)
            && *known == stamp
        {
            return Ok(Arc::clone(source));
        }
        let bytes = fs::read(path).map_err(failure)?;
        let source = parsed(path, &String::from_utf8_lossy(&bytes), dialect);
        if state.read.len() < MOST_KEPT_FILES || state.read.contains_key(&key) {
            state.read.insert(key, (stamp, Arc::clone(&source)));
        }
        Ok(source)
    }
}

fn parsed(path: &Path, text: &str, dialect: Dialect) -> Arc<SourceFile> {
    Arc::new(SourceFile { path: path.to_owned(), tree: SyntaxTree::parse(text, dialect) })
}

fn shown(path: &Path) -> SmolStr {
    format_smolstr!("{}", path.display())
}

/// The path without `.` and `..`, so that one file has one path; links are not followed.
pub fn normalised(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if matches!(plain.components().next_back(), Some(Component::Normal(_))) => {
                plain.pop();
            }
            other => plain.push(other),
        }
    }
    plain
}

/// Where a program stands, which files are open beside it, and what it was before it was a text.
#[derive(Debug, Clone, Default)]
pub struct Surroundings {
    /// The path of the program; without one, nothing is beside it.
    pub path: Option<PathBuf>,
    /// Files open in an editor, and what was read of others.
    pub files: Files,
    /// The system of the binary file that the text was made of.
    pub binary: Option<ClDialect>,
}

/// Looks for included files in folders.
#[derive(Debug)]
pub(crate) struct FolderResolver {
    program: Option<PathBuf>,
    folders: Vec<PathBuf>,
    dialect: Dialect,
    files: Files,
}

impl FolderResolver {
    /// The folders for a program: its own, then those of the settings, which are relative to it.
    pub(crate) fn new(surroundings: &Surroundings, include: &[String], dialect: Dialect) -> Arc<Self> {
        let program = surroundings.path.as_deref().map(normalised);
        let own = program.as_deref().and_then(Path::parent).map_or_else(PathBuf::new, Path::to_owned);
        let given = include.iter().map(|folder| normalised(&own.join(folder)));
        let mut folders: Vec<PathBuf> = Vec::new();
        for folder in std::iter::once(own.clone()).chain(given) {
            if !folders.contains(&folder) {
                folders.push(folder);
            }
        }
        Arc::new(Self { program, folders, dialect, files: surroundings.files.clone() })
    }

    fn find(&self, name: &str) -> Option<PathBuf> {
        // A program must not read what lies outside of the folders that were given.
        let stays =
            |name: &str| Path::new(name).components().all(|part| matches!(part, Component::Normal(_)));
        if name.is_empty() || !stays(name) {
            return None;
        }
        // Programs are written in capitals, files often are not.
        let spellings = [name.to_owned(), name.to_ascii_lowercase()];
        self.folders.iter().find_map(|folder| {
            let mut paths = spellings
                .iter()
                .flat_map(|name| ENDINGS.iter().map(move |ending| folder.join(format!("{name}{ending}"))));
            paths.find(|path| self.is_program(path) || self.files.is_file(path))
        })
    }
}

impl IncludeResolver for FolderResolver {
    fn resolve(&self, name: &str) -> Result<Arc<SourceFile>, IncludeFailure> {
        match self.find(name) {
            // It is known without being read, and cannot be included anyway.
            Some(path) if self.is_program(&path) => Ok(parsed(&path, "", self.dialect)),
            Some(path) => self.files.source(&path, self.dialect),
            None => {
                let folder = |folder: &PathBuf| match folder.as_os_str().is_empty() {
                    true => SmolStr::new_static("the folder of the program"),
                    false => shown(folder),
                };
                Err(IncludeFailure::NotFound { searched: self.folders.iter().map(folder).collect() })
            }
        }
    }

    fn is_program(&self, path: &Path) -> bool {
        self.program.as_deref() == Some(path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("apt-run-{name}-{}", std::process::id()));
        fs::create_dir_all(folder.join("parts")).unwrap();
        fs::create_dir_all(folder.join("lib")).unwrap();
        folder
    }

    fn resolver(folder: &Path, files: &Files) -> Arc<FolderResolver> {
        let path = Some(folder.join("parts/main.apt"));
        let surroundings = Surroundings { path, files: files.clone(), ..Surroundings::default() };
        FolderResolver::new(&surroundings, &["../lib".to_owned()], Dialect::named(DialectName::Free))
    }

    #[test]
    fn files_are_found_beside_the_program_then_in_the_folders() {
        let folder = folder("include");
        fs::write(folder.join("parts/near.apt"), "A=1\n").unwrap();
        fs::write(folder.join("lib/FAR"), "A=2\nB=3\n").unwrap();
        fs::write(folder.join("secret"), "A=4\n").unwrap();
        let resolver = resolver(&folder, &Files::default());
        let count = |name: &str| resolver.resolve(name).map(|source| source.tree.statement_count()).ok();
        assert_eq!(count("NEAR"), Some(1), "lower case and ending are tried");
        assert_eq!(count("FAR"), Some(2));
        assert_eq!(count("../secret"), None, "a program cannot leave the folders");
        assert_eq!(count(""), None);
        let searched = [folder.join("parts"), folder.join("lib")].map(|folder| shown(&folder)).to_vec();
        assert_eq!(resolver.resolve("NONE"), Err(IncludeFailure::NotFound { searched }));
        assert!(
            resolver.is_program(&resolver.resolve("MAIN").unwrap().path),
            "the program is known as itself"
        );
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn what_is_open_counts_in_place_of_the_disk() {
        let folder = folder("open");
        let path = folder.join("lib/part.apt");
        fs::write(&path, "A=1\n").unwrap();
        let files = Files::default();
        let resolver = resolver(&folder, &files);
        let count = || resolver.resolve("PART").map(|source| source.tree.statement_count());
        let first = resolver.resolve("PART").unwrap();
        assert!(
            Arc::ptr_eq(&first, &resolver.resolve("PART").unwrap()),
            "what did not change is not read again"
        );
        files.open(&path, Arc::new(|| "A=1\nB=2\n".to_owned()));
        assert_eq!(count(), Ok(2));
        files.open(&folder.join("parts/../lib/new.apt"), Arc::new(|| "A=1\n".to_owned()));
        assert!(resolver.resolve("NEW").is_ok(), "a file that was never saved");
        files.close(&path);
        assert_eq!(count(), Ok(1));
        fs::write(&path, "A=1\nB=2\nC=3\n").unwrap();
        assert_eq!(count(), Ok(3), "a change on the disk is seen");
        fs::remove_dir_all(&folder).unwrap();
    }
}
