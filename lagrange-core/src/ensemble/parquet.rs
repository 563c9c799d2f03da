//! Tables of ensembles in Parquet files.
//!
//! A Parquet file stores its schema in its last bytes, so a truncated file cannot be read at all. A table is therefore
//! a directory of files. Each file is written completely under a temporary name, then renamed: every file with its
//! final name is complete. Programs that read Parquet accept such a directory as one table.

mod file;

use core::cell::OnceCell;
use core::fmt::{self, Debug, Formatter};
use core::time::Duration;
use std::fs::{File, create_dir_all, read_dir, remove_file, rename};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use parquet::file::reader::SerializedFileReader;
use serde::{Deserialize, Serialize};

use self::file::FileFault;
use super::fingerprint::{Fingerprint, Hash, OTHER_START};
use super::line::{Line, NamedNumbers};
use super::names::ColumnNames;
use super::outcome::Member;
use super::row::MemberRow;
use super::table::MemberTable;
use crate::StateOf;
use crate::error::{EnsembleError, Error};
use crate::generic::{Element, StaticLength};
use crate::linearized::Linearized;
use crate::linearized::argument::check_parameters;
use crate::number::Real;

/// A table of members in a directory of Parquet files; rows are appended as members finish.
///
/// The columns are the fields of a [`MemberRow`], and the groups `start` and `parameters`: the initial state of the member
/// and its parameters by name. In polars, `table.explode("samples").unnest("samples")` has a row per sample. The metadata
/// of each file hold the [`Fingerprint`] of member 0 and the equations as text.
///
/// Files are written every 10 s ([`every`](Self::every)), when the table is dropped, and by [`flush`](Self::flush),
/// which returns errors. A program that is killed loses the rows since the last file. Several tables, of programs on
/// several machines, may write into one directory.
///
/// ```
/// use std::ops::ControlFlow;
/// use lagrange_core::ensemble::ParquetTable;
/// use lagrange_core::prelude::*;
///
/// #[derive(Lagrangian)]
/// #[coordinates(x)]
/// #[lagrangian(x_dot^2/2 - k/2 * x^2)]
/// struct Spring<T> { k: T }
///
/// let member = |n: usize| (Spring { k: n as f64 }, State::at_rest([1.0]));
/// # let directory = std::env::temp_dir().join(format!("lagrange-springs-{}", std::process::id()));
/// let mut table = ParquetTable::open(&directory, member)?;
/// let done = table.read()?;
/// let outcome = Ensemble::from_fn(100, member)
///     .resume_from(done)?
///     .on_progress(|progress| match table.push(progress.member) {
///         Ok(()) => ControlFlow::Continue(()),
///         Err(_) => ControlFlow::Break(()),
///     })
///     .integrate_on_lanes(1.0, Dop853::default())?;
/// // Write the rows that still wait, and return errors: the disk may have been full.
/// table.flush()?;
/// assert_eq!(table.read()?.rows().len(), 100);
/// # std::fs::remove_dir_all(&directory).unwrap();
/// # Ok::<(), Error>(())
/// ```
pub struct ParquetTable<'a, L: Linearized<Scalar: Real>> {
    directory: PathBuf,
    member: Box<dyn Fn(usize) -> (L, StateOf<L>) + Send + 'a>,
    interval: Duration,
    /// Rows not yet written to a file; `since` is the time of the first.
    waiting: Vec<MemberRow<L::Scalar, L::N>>,
    since: Instant,
    /// Members below this index were compared: their starts and parameters agree with the files of the directory.
    compared: usize,
    /// [`Fingerprint::start`] of member 0, computed at first use.
    first: OnceCell<u32>,
    damaged: Vec<Error>,
}

impl<'a, L: Linearized<Scalar: Real>> ParquetTable<'a, L> {
    /// Opens the table in this directory, and creates the directory if it does not exist. `member` is the function that
    /// the ensemble is [made from](super::Ensemble::from_fn).
    ///
    /// # Errors
    /// [`EnsembleError::Parquet`] if the directory cannot be created.
    pub fn open(
        directory: impl AsRef<Path>,
        member: impl Fn(usize) -> (L, StateOf<L>) + Send + 'a,
    ) -> Result<Self, Error> {
        const { check_parameters::<L>() };
        let directory = directory.as_ref().to_owned();
        create_dir_all(&directory).map_err(|error| wrong(&directory, error))?;
        Ok(Self {
            directory,
            member: Box::new(member),
            interval: Duration::from_secs(10),
            waiting: Vec::new(),
            since: Instant::now(),
            compared: 0,
            first: OnceCell::new(),
            damaged: Vec::new(),
        })
    }

    /// Sets the longest time that rows wait before a file is written.
    pub fn every(mut self, interval: Duration) -> Self {
        self.interval = interval;
        self
    }

    /// Appends the row of a member.
    ///
    /// # Errors
    /// [`EnsembleError::OtherRun`] if the member belongs to another run than the waiting rows, or was made from another
    /// start. When a file is due, also the errors of [`flush`](Self::flush); the row then waits with the others.
    pub fn push(&mut self, member: &Member<L::Scalar, L::N>) -> Result<(), Error> {
        let (system, start) = (self.member)(member.index);
        let known = self.waiting.first().map_or(member.fingerprint, |row| row.fingerprint);
        if let Some(differs) = known.with_start(&system, &start).difference(&member.fingerprint) {
            return Err(Error::Ensemble(EnsembleError::OtherRun { member: member.index, differs }));
        }
        if self.waiting.is_empty() {
            self.since = Instant::now();
        }
        self.waiting.push(member.row());
        if self.since.elapsed() < self.interval { Ok(()) } else { self.flush() }
    }

    /// Writes the waiting rows to a file.
    ///
    /// # Errors
    /// [`EnsembleError::Parquet`] if the file cannot be written, if the directory holds files of another run or system,
    /// or if it holds rows of members with another start or other parameters. For this check, members are constructed
    /// up to the last waiting one; of rows beyond it only member 0 of their run is compared. After an error the rows
    /// keep waiting: make room and flush again.
    pub fn flush(&mut self) -> Result<(), Error> {
        if self.waiting.is_empty() {
            return Ok(());
        }
        let end = 1 + self.waiting.iter().map(|row| row.index).max().unwrap_or(0);
        if end > self.compared {
            self.files()?.iter().try_for_each(|path| self.compare(path, end))?;
            self.compared = end;
        }
        self.write(&self.waiting)?;
        self.waiting.clear();
        Ok(())
    }

    /// Reads the rows of all files, ordered by member. If a member has several rows, the first that did not fail takes
    /// precedence. Truncated files are skipped; [`damaged`](Self::damaged) lists them.
    ///
    /// # Errors
    /// [`EnsembleError::Parquet`] if a file belongs to another system (by its columns or equations) or has another
    /// member 0, if the files belong to several runs, or if the directory cannot be read.
    pub fn read(&mut self) -> Result<MemberTable<L::Scalar, L::N>, Error> {
        self.damaged.clear();
        let mut found = Vec::new();
        for path in self.files()? {
            match self.rows_in(&path) {
                Ok(read) => found.extend(read.into_iter().map(|row| (path.clone(), row))),
                Err(FileFault::Damaged(reason)) => self.damaged.push(wrong(&path, reason)),
                Err(FileFault::Other(reason)) => return Err(wrong(&path, reason)),
            }
        }
        MemberTable::gather(Fingerprint::of_system::<L>(), found, |path, reason| wrong(&path, reason))
    }

    /// One error for each file that the last [`read`](Self::read) skipped.
    pub fn damaged(&self) -> &[Error] {
        &self.damaged
    }

    /// Merges all files into one, drops duplicate rows, and removes damaged and unfinished files. Nothing else may
    /// write into the directory at the same time.
    ///
    /// # Errors
    /// The errors of [`flush`](Self::flush) and [`read`](Self::read). No row is lost.
    pub fn clean(&mut self) -> Result<(), Error> {
        self.flush()?;
        let table = self.read()?;
        let old = self.listed(|name| is_file(name) || name.ends_with(UNFINISHED))?;
        let new = if table.rows().is_empty() { None } else { Some(self.write(table.rows())?) };
        for path in old.iter().filter(|path| Some(*path) != new.as_ref()) {
            remove_file(path).map_err(|error| wrong(path, error))?;
        }
        Ok(())
    }

    fn files(&self) -> Result<Vec<PathBuf>, Error> {
        self.listed(is_file)
    }

    /// Paths of the files in the directory whose name passes `is_meant`, sorted.
    fn listed(&self, is_meant: impl Fn(&str) -> bool) -> Result<Vec<PathBuf>, Error> {
        let entries = read_dir(&self.directory).and_then(Iterator::collect::<Result<Vec<_>, _>>);
        let entries = entries.map_err(|error| wrong(&self.directory, error))?;
        let meant = entries.iter().filter(|entry| entry.file_name().to_str().is_some_and(&is_meant));
        let mut paths: Vec<_> = meant.map(|entry| entry.path()).collect();
        paths.sort();
        Ok(paths)
    }

    fn rows_in(&self, path: &Path) -> Result<Vec<MemberRow<L::Scalar, L::N>>, FileFault> {
        let mut names = Arc::new(ColumnNames::new(L::COORDINATES, Vec::new()));
        let reader = self.reader(path)?;
        let lines = file::rows(&reader, |_| true)?;
        lines
            .map(|line| Line::into_row(line?, &mut names).map_err(|reason| FileFault::Other(reason.into())))
            .collect()
    }

    /// Opens a file, and checks that its member 0 has the start and the parameters that `member` gives.
    fn reader(&self, path: &Path) -> Result<SerializedFileReader<File>, FileFault> {
        let file = File::open(path).map_err(|error| FileFault::Other(error.to_string()))?;
        let reader = SerializedFileReader::new(file)?;
        let first = file::first(&reader)?;
        if first.system == Fingerprint::of_system::<L>() && first.start != self.first() {
            return Err(FileFault::Other(OTHER_START.into()));
        }
        Ok(reader)
    }

    /// [`Fingerprint::start`] of member 0, which every run of an ensemble can compute.
    fn first(&self) -> u32 {
        *self.first.get_or_init(|| {
            let (system, start) = (self.member)(0);
            Fingerprint { system: 0, run: 0, start: 0 }.with_start(&system, &start).start
        })
    }

    /// Checks that the rows of a file belong to the run of the waiting rows, and that members below `end`
    /// have the starts and the parameters that `member` gives.
    fn compare(&self, path: &Path, end: usize) -> Result<(), Error> {
        match self.compare_rows(path, end) {
            // A damaged file contributes no rows, so there is nothing to compare.
            Ok(()) | Err(FileFault::Damaged(_)) => Ok(()),
            Err(FileFault::Other(reason)) => Err(wrong(path, reason)),
        }
    }

    fn compare_rows(&self, path: &Path, end: usize) -> Result<(), FileFault> {
        #[derive(Deserialize)]
        struct Identity {
            member: usize,
            fingerprint: Fingerprint,
        }
        let run = self.waiting[0].fingerprint;
        let reader = self.reader(path)?;
        for row in file::rows(&reader, |name| ["member", "fingerprint"].contains(&name))? {
            let Identity { member, fingerprint } = row?;
            // The file may hold indices for which `member` cannot make a member.
            let expected = if member < end {
                let (system, start) = (self.member)(member);
                run.with_start(&system, &start)
            } else {
                Fingerprint { start: fingerprint.start, ..run }
            };
            if let Some(reason) = expected.difference(&fingerprint) {
                return Err(FileFault::Other(reason.into()));
            }
        }
        Ok(())
    }

    fn file_row<'r>(&self, row: &'r MemberRow<L::Scalar, L::N>) -> FileRow<'r> {
        let (system, start) = (self.member)(row.index);
        let mut parameters = Vec::new();
        system.visit_parameters(&mut |_, x| parameters.push(x));
        let parameters = NamedNumbers::named(L::PARAMETERS, parameters);
        FileRow { line: Line::of(row), start: NamedNumbers::of(&row.names, &start), parameters }
    }

    /// Writes a file of these rows under a temporary name, and renames it when it is complete.
    fn write(&self, rows: &[MemberRow<L::Scalar, L::N>]) -> Result<PathBuf, Error> {
        let names = &rows[0].names;
        let file_rows = rows.iter().map(|row| self.file_row(row));
        let first = Fingerprint { start: self.first(), ..rows[0].fingerprint };
        let path = self.directory.join(name(rows));
        let unfinished = path.with_extension(&UNFINISHED[1..]);
        let written = File::create(&unfinished).map_err(FileFault::from).and_then(|file| {
            let schema = file::schema(names, L::PARAMETERS)?;
            file::write(&file, schema, file_rows, first, [L::NAME, L::EQUATIONS.text()])?;
            file.sync_all()?;
            Ok(rename(&unfinished, &path)?)
        });
        match written {
            Ok(()) => Ok(path),
            Err(FileFault::Damaged(reason)) => {
                // A partial file is useless, and takes up space if the disk is full.
                let _ = remove_file(&unfinished);
                Err(wrong(&path, reason))
            }
            Err(FileFault::Other(reason)) => Err(wrong(&path, reason)),
        }
    }
}

/// A row of a file.
#[derive(Serialize)]
struct FileRow<'r> {
    #[serde(flatten)]
    line: Line<'r>,
    start: NamedNumbers<'r>,
    parameters: NamedNumbers<'r>,
}

const UNFINISHED: &str = ".unfinished";

fn is_file(name: &str) -> bool {
    name.ends_with(".parquet")
}

/// File name derived from the rows: equal for equal rows, different otherwise. Programs that write into one directory
/// do not overwrite each other's files.
fn name<T: Element, N: StaticLength>(rows: &[MemberRow<T, N>]) -> String {
    let mut hash = Hash::new();
    for row in rows {
        let Fingerprint { system, run, start } = row.fingerprint;
        [system, run, start].iter().for_each(|part| hash.bytes(&part.to_le_bytes()));
        hash.bytes(&row.index.to_le_bytes());
        hash.text(&row.ending.to_string());
    }
    let first = rows.iter().map(|row| row.index).min().unwrap_or(0);
    format!("rows-{first:09}-{}-{:08x}.parquet", rows.len(), hash.value())
}

fn wrong(path: &Path, reason: impl ToString) -> Error {
    Error::Ensemble(EnsembleError::Parquet { file: path.display().to_string(), reason: reason.to_string() })
}

impl<L: Linearized<Scalar: Real>> Drop for ParquetTable<'_, L> {
    fn drop(&mut self) {
        // A destructor cannot return errors; call `flush` to see them.
        let _ = self.flush();
    }
}

impl<L: Linearized<Scalar: Real>> Debug for ParquetTable<'_, L> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let (directory, waiting) = (&self.directory, self.waiting.len());
        f.debug_struct("ParquetTable").field("directory", directory).field("waiting", &waiting).finish()
    }
}
