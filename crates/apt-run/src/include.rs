//! Where INCLUD finds its files: beside the program, then in the folders of the settings.

use std::{
    fs,
    path::{Component, Path, PathBuf},
    sync::Arc,
};

use apt_program::IncludeResolver;
use apt_syntax::{SyntaxTree, dialect::Dialect};

/// Endings that are tried when a name has none. Names of part programs have no dots.
const ENDINGS: [&str; 3] = ["", ".apt", ".inc"];
/// Largest file that is taken, bytes; far above any part program, far below what would fill the memory.
const LARGEST_FILE: u64 = 64 << 20;

/// Looks for included files in folders.
#[derive(Debug)]
pub(crate) struct FolderResolver {
    folders: Vec<PathBuf>,
    dialect: Dialect,
}

impl FolderResolver {
    /// The folders for a program: its own, then those of the settings, which are relative to it.
    pub(crate) fn new(file: Option<&str>, include: &[String], dialect: Dialect) -> Arc<Self> {
        let own = file.and_then(|file| Path::new(file).parent()).map_or_else(PathBuf::new, Path::to_owned);
        let folders = std::iter::once(own.clone()).chain(include.iter().map(|folder| own.join(folder)));
        Arc::new(Self { folders: folders.collect(), dialect })
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
            let paths = spellings
                .iter()
                .flat_map(|name| ENDINGS.iter().map(move |ending| folder.join(format!("{name}{ending}"))));
            paths.into_iter().find(|path| {
                fs::metadata(path).is_ok_and(|found| found.is_file() && found.len() <= LARGEST_FILE)
            })
        })
    }
}

impl IncludeResolver for FolderResolver {
    fn resolve(&self, name: &str) -> Option<SyntaxTree> {
        let bytes = fs::read(self.find(name)?).ok()?;
        Some(SyntaxTree::parse(&String::from_utf8_lossy(&bytes), self.dialect))
    }
}

#[cfg(test)]
mod tests {
    use apt_syntax::DialectName;

    use super::*;

    #[test]
    fn files_are_found_beside_the_program_then_in_the_folders() {
        let folder = std::env::temp_dir().join(format!("apt-run-include-{}", std::process::id()));
        fs::create_dir_all(folder.join("parts")).unwrap();
        fs::create_dir_all(folder.join("lib")).unwrap();
        fs::write(folder.join("parts/near.apt"), "A=1\n").unwrap();
        fs::write(folder.join("lib/FAR"), "A=2\nB=3\n").unwrap();
        fs::write(folder.join("secret"), "A=4\n").unwrap();
        let program = folder.join("parts/main.apt");
        let resolver = FolderResolver::new(
            Some(&program.to_string_lossy()),
            &["../lib".to_owned()],
            Dialect::named(DialectName::Free),
        );
        let count = |name: &str| resolver.resolve(name).map(|tree| tree.statement_count());
        assert_eq!(count("NEAR"), Some(1), "lower case and ending are tried");
        assert_eq!(count("FAR"), Some(2));
        assert_eq!(count("NONE"), None);
        assert_eq!(count("../secret"), None, "a program cannot leave the folders");
        assert_eq!(count(""), None);
        fs::remove_dir_all(&folder).unwrap();
    }
}
