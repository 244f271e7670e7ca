//! Files that are written: all at once, so that an end of this process never leaves half of one.

use std::ffi::OsString;
use std::fs::{self, OpenOptions};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

/// Gives a file its contents; it may be there already, and be reached by a link. What is no file, as a device, gets them as they
/// come.
pub(super) fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    match fs::metadata(path) {
        Ok(there) if there.is_file() => match replace(path, bytes) {
            // A folder may take no new name while the file in it may be written.
            Err(error) if error.kind() == io::ErrorKind::PermissionDenied => fs::write(path, bytes),
            replaced => replaced,
        },
        // A link that leads nowhere makes the file that it leads to.
        Err(error) if error.kind() == io::ErrorKind::NotFound && fs::symlink_metadata(path).is_err() => {
            put(path, bytes, None)
        }
        _ => fs::write(path, bytes),
    }
}

/// Gives a file that is there new contents.
pub(super) fn replace(file: &Path, bytes: &[u8]) -> io::Result<()> {
    let file = fs::canonicalize(file)?;
    // Who may not write a file is not to write it by another way.
    drop(OpenOptions::new().write(true).open(&file)?);
    let permissions = fs::metadata(&file)?.permissions();
    put(&file, bytes, Some(permissions))
}

/// Writes beside the place of a file, and then puts it there.
fn put(file: &Path, bytes: &[u8], permissions: Option<fs::Permissions>) -> io::Result<()> {
    let temporary = beside(file)?;
    let written = (|| {
        let mut output = OpenOptions::new().write(true).create_new(true).open(&temporary)?;
        output.write_all(bytes)?;
        output.sync_all()?;
        if let Some(permissions) = permissions {
            fs::set_permissions(&temporary, permissions)?;
        }
        fs::rename(&temporary, file)
    })();
    if written.is_err() {
        // What is left behind concerns nobody; the reason is told.
        let _ = fs::remove_file(&temporary);
    }
    written
}

/// A name beside a file that nobody else uses.
fn beside(file: &Path) -> io::Result<PathBuf> {
    let name = file.file_name().ok_or_else(|| io::Error::from(io::ErrorKind::InvalidInput))?;
    let mut temporary = OsString::from(".");
    temporary.push(name);
    temporary.push(format!(".{}.tmp", std::process::id()));
    Ok(file.with_file_name(temporary))
}
