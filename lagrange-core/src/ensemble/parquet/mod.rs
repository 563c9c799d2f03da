//! Tables of ensembles as Parquet.
//!
//! What a file of Parquet holds is known by its last bytes alone: one that was cut off has nothing. So a table is a directory of
//! files, each written whole under another name and then renamed; what is there is there to its end. Programs that read Parquet
//! take such a directory for one table.

mod file;
mod rows;

use core::cell::OnceCell;
use core::fmt::{self, Debug, Formatter};
use core::time::Duration;
use std::fs::{File, create_dir_all, read_dir, remove_file, rename};
use std::path::{Path, PathBuf};
use std::time::Instant;

use self::file::FileFault;
use self::rows::{columns, rows};
use super::fingerprint::{Fingerprint, Hash, OTHER_START};
use super::outcome::Member;
use super::table::{MemberRow, MemberTable};
use crate::error::{EnsembleError, Error};
use crate::linearized::Linearized;
use crate::number::Real;
use crate::system::State;

/// A table of members in a directory of Parquet files, to which rows are appended as members are done.
///
/// Each row has its member's start and its parameters by name beside what a row of [`csv`](super::Outcome::csv) has: the
/// columns `member`, `fingerprint` (of the start) and `ending`, and the groups `start`, `parameters` and `end`, the last without
/// entries where there is no motion. Each file says of which run it is ([`Fingerprint`]), and has the equations as text.
///
/// Files are written every 10 s ([`every`](Self::every)), when the table is dropped, and by [`flush`](Self::flush), which
/// says what went wrong. A program that is killed loses the rows since. Several tables, of programs on several machines, may
/// write into one directory.
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
/// // The disk may have been full: what is waiting is written, or the error told.
/// table.flush()?;
/// assert_eq!(table.read()?.rows().len(), 100);
/// # std::fs::remove_dir_all(&directory).unwrap();
/// # Ok::<(), Error>(())
/// ```
pub struct ParquetTable<'a, L, T, const N: usize, const M: usize, const P: usize>
where
    L: Linearized<N, M, P, Scalar = T>,
    T: Real,
{
    directory: PathBuf,
    member: Box<dyn Fn(usize) -> (L, State<T, N>) + Send + 'a>,
    interval: Duration,
    /// Rows that are in no file yet, and since when there are any.
    waiting: Vec<MemberRow<T, N>>,
    since: Instant,
    /// The members below this one are known to start in the files of the directory as they are made here.
    compared: usize,
    /// [`Fingerprint::start`] of member 0, once it was made.
    first: OnceCell<u32>,
    damaged: Vec<Error>,
}

impl<'a, L, T, const N: usize, const M: usize, const P: usize> ParquetTable<'a, L, T, N, M, P>
where
    L: Linearized<N, M, P, Scalar = T>,
    T: Real,
{
    /// The table in this directory, which is made where there is none. `member` is what the ensemble is
    /// [made from](super::Ensemble::from_fn).
    ///
    /// # Errors
    /// [`EnsembleError::Parquet`], if there is no such directory and none can be made.
    pub fn open(
        directory: impl AsRef<Path>,
        member: impl Fn(usize) -> (L, State<T, N>) + Send + 'a,
    ) -> Result<Self, Error> {
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

    /// How long rows may wait for a file to be written.
    pub fn every(mut self, interval: Duration) -> Self {
        self.interval = interval;
        self
    }

    /// Appends the row of a member.
    ///
    /// # Errors
    /// [`EnsembleError::OtherRun`], if it is of another run than the rows that wait, or was made from another start. As
    /// [`flush`](Self::flush), when it is time for a file; the row waits then as the others do.
    pub fn push(&mut self, member: &Member<T, N>) -> Result<(), Error> {
        let (system, start) = (self.member)(member.index);
        let known = self.waiting.first().map_or(member.fingerprint, |row| row.fingerprint);
        if let Some((_, differs)) = known.with_start(&system, &start).difference(&member.fingerprint) {
            return Err(Error::Ensemble(EnsembleError::OtherRun { member: member.index, differs }));
        }
        if self.waiting.is_empty() {
            self.since = Instant::now();
        }
        self.waiting.push(member.row());
        if self.since.elapsed() < self.interval { Ok(()) } else { self.flush() }
    }

    /// Writes the rows that wait into a file.
    ///
    /// # Errors
    /// [`EnsembleError::Parquet`], where that cannot be done, or the directory holds files of another run or of another system, or rows of
    /// members with another start or other parameters. To see that, members are made up to the last that waits; of those beyond
    /// it nothing is known yet, but that their member 0 was the same. The rows go on waiting: make room and flush again.
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

    /// The rows in the files, by member. Of several rows of one member one that arrived counts, where there is one. Files
    /// that were cut off are passed over: [`damaged`](Self::damaged) names them.
    ///
    /// # Errors
    /// [`EnsembleError::Parquet`] for files of another system, by its columns or by its equations, or with another member 0, for files of
    /// several runs, and where the directory cannot be read.
    pub fn read(&mut self) -> Result<MemberTable<T, N>, Error> {
        self.damaged.clear();
        let mut found = Vec::new();
        for path in self.files()? {
            match self.rows_in(&path) {
                Ok(read) => found.extend(read.into_iter().map(|row| (path.clone(), row))),
                Err(FileFault::Damaged(reason)) => self.damaged.push(wrong(&path, reason)),
                Err(FileFault::Other(reason)) => return Err(wrong(&path, reason)),
            }
        }
        MemberTable::gather(L::COORDINATES, Fingerprint::of_system::<L, N, M>(), found, |path, _, reason| {
            wrong(&path, reason)
        })
    }

    /// What is wrong with each file that was passed over when the table was [read](Self::read) last.
    pub fn damaged(&self) -> &[Error] {
        &self.damaged
    }

    /// Makes one file of all, without the rows that are there twice, and removes what is damaged or was not written to its
    /// end. Nothing else may write into the directory meanwhile.
    ///
    /// # Errors
    /// As [`flush`](Self::flush) and [`read`](Self::read). No row is lost.
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

    /// What is in the directory under such names, in their order.
    fn listed(&self, is_meant: impl Fn(&str) -> bool) -> Result<Vec<PathBuf>, Error> {
        let entries = read_dir(&self.directory).and_then(Iterator::collect::<Result<Vec<_>, _>>);
        let entries = entries.map_err(|error| wrong(&self.directory, error))?;
        let meant = entries.iter().filter(|entry| entry.file_name().to_str().is_some_and(&is_meant));
        let mut paths: Vec<_> = meant.map(|entry| entry.path()).collect();
        paths.sort();
        Ok(paths)
    }

    /// The rows of a file, whose member 0 must be the one that is made here.
    fn rows_in(&self, path: &Path) -> Result<Vec<MemberRow<T, N>>, FileFault> {
        let file = File::open(path).map_err(|error| FileFault::Other(error.to_string()))?;
        let read = file::read(file, columns::<L, T, N, M, P>(&[], &[]))?;
        let (.., first) = &read;
        if first.system == Fingerprint::of_system::<L, N, M>() && first.start != self.first() {
            return Err(FileFault::Other(OTHER_START.into()));
        }
        rows::<T, N, P>(&read)
    }

    /// [`Fingerprint::start`] of member 0, which every run of an ensemble can make.
    fn first(&self) -> u32 {
        *self.first.get_or_init(|| {
            let (system, start) = (self.member)(0);
            Fingerprint { system: 0, run: 0, start: 0 }.with_start(&system, &start).start
        })
    }

    /// Checks that the rows in a file are of the run of those that wait, and those below `end` of members that start as they
    /// are made here.
    fn compare(&self, path: &Path, end: usize) -> Result<(), Error> {
        let rows = match self.rows_in(path) {
            Ok(rows) => rows,
            // No row of it is read.
            Err(FileFault::Damaged(_)) => return Ok(()),
            Err(FileFault::Other(reason)) => return Err(wrong(path, reason)),
        };
        let run = self.waiting[0].fingerprint;
        for row in rows {
            // There may be more members in the file than can be made.
            let expected = if row.index < end {
                let (system, start) = (self.member)(row.index);
                run.with_start(&system, &start)
            } else {
                Fingerprint { start: row.fingerprint.start, ..run }
            };
            if let Some((_, reason)) = expected.difference(&row.fingerprint) {
                return Err(wrong(path, reason));
            }
        }
        Ok(())
    }

    /// A file of these rows, there when it is whole.
    fn write(&self, rows: &[MemberRow<T, N>]) -> Result<PathBuf, Error> {
        let made: Vec<_> = rows.iter().map(|row| (self.member)(row.index)).collect();
        let columns = columns(rows, &made);
        let has_end: Vec<bool> = rows.iter().map(|row| row.state.is_some()).collect();
        let first = Fingerprint { start: self.first(), ..rows[0].fingerprint };
        let path = self.directory.join(name(rows));
        let unfinished = path.with_extension(&UNFINISHED[1..]);
        let written = File::create(&unfinished).map_err(FileFault::from).and_then(|file| {
            file::write(&file, &columns, &has_end, first, [L::NAME, L::EQUATIONS.text()])?;
            file.sync_all()?;
            Ok(rename(&unfinished, &path)?)
        });
        match written {
            Ok(()) => Ok(path),
            Err(FileFault::Damaged(reason)) => {
                // What is left of it helps nobody, and where the disk is full it is in the way.
                let _ = remove_file(&unfinished);
                Err(wrong(&path, reason))
            }
            Err(FileFault::Other(reason)) => Err(wrong(&path, reason)),
        }
    }
}

const UNFINISHED: &str = ".unfinished";

fn is_file(name: &str) -> bool {
    name.ends_with(".parquet")
}

/// The same for the same rows, and another for others: programs that write into one directory do not meet.
fn name<T, const N: usize>(rows: &[MemberRow<T, N>]) -> String {
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

impl<L, T, const N: usize, const M: usize, const P: usize> Drop for ParquetTable<'_, L, T, N, M, P>
where
    L: Linearized<N, M, P, Scalar = T>,
    T: Real,
{
    fn drop(&mut self) {
        // Who wants to know flushes.
        let _ = self.flush();
    }
}

impl<L, T, const N: usize, const M: usize, const P: usize> Debug for ParquetTable<'_, L, T, N, M, P>
where
    L: Linearized<N, M, P, Scalar = T>,
    T: Real,
{
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let (directory, waiting) = (&self.directory, self.waiting.len());
        f.debug_struct("ParquetTable").field("directory", directory).field("waiting", &waiting).finish()
    }
}
