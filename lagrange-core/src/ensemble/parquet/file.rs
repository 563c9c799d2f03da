//! Reads and writes one Parquet file of a table, as columns of numbers and texts.

use std::fs::File;
use std::io::Write;
use std::sync::Arc;

use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::column::reader::ColumnReader;
use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::errors::{ParquetError, Result};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, RowGroupReader, SerializedFileReader};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{Type, TypePtr};

use crate::ensemble::fingerprint::Fingerprint;

/// A column of a file. Columns of the group `end` have no entries in the rows of members that did not start.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Column {
    /// Parquet group that contains the column; empty at the top level.
    pub(super) group: &'static str,
    pub(super) name: String,
    pub(super) values: Values,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Values {
    Integers(Vec<i64>),
    Numbers(Vec<f64>),
    Flags(Vec<bool>),
    Texts(Vec<ByteArray>),
}

/// Optional group for the end of the motion; null for a member that did not start.
pub(super) const END: &str = "end";

impl Values {
    pub(super) fn integer(&self, place: usize) -> Option<i64> {
        if let Self::Integers(values) = self { values.get(place).copied() } else { None }
    }

    pub(super) fn number(&self, place: usize) -> Option<f64> {
        if let Self::Numbers(values) = self { values.get(place).copied() } else { None }
    }

    pub(super) fn flag(&self, place: usize) -> Option<bool> {
        if let Self::Flags(values) = self { values.get(place).copied() } else { None }
    }

    pub(super) fn text(&self, place: usize) -> Option<&str> {
        if let Self::Texts(values) = self { values.get(place)?.as_utf8().ok() } else { None }
    }

    fn physical(&self) -> Physical {
        match self {
            Self::Integers(_) => Physical::INT64,
            Self::Numbers(_) => Physical::DOUBLE,
            Self::Flags(_) => Physical::BOOLEAN,
            Self::Texts(_) => Physical::BYTE_ARRAY,
        }
    }

    fn write(&self, to: &mut ColumnWriter<'_>, levels: Option<&[i16]>) -> Result<usize> {
        match (self, to) {
            (Self::Integers(values), ColumnWriter::Int64ColumnWriter(to)) => {
                to.write_batch(values, levels, None)
            }
            (Self::Numbers(values), ColumnWriter::DoubleColumnWriter(to)) => {
                to.write_batch(values, levels, None)
            }
            (Self::Flags(values), ColumnWriter::BoolColumnWriter(to)) => to.write_batch(values, levels, None),
            (Self::Texts(values), ColumnWriter::ByteArrayColumnWriter(to)) => {
                to.write_batch(values, levels, None)
            }
            _ => Err(other_columns()),
        }
    }

    /// Appends the next `rows` rows of a column; `levels` receives 1 for each row of an optional group that has an
    /// entry, else 0.
    fn read(
        &mut self,
        from: ColumnReader,
        rows: usize,
        levels: &mut Vec<i16>,
    ) -> Result<(usize, usize, usize)> {
        let levels = Some(levels);
        match (self, from) {
            (Self::Integers(to), ColumnReader::Int64ColumnReader(mut from)) => {
                from.read_records(rows, levels, None, to)
            }
            (Self::Numbers(to), ColumnReader::DoubleColumnReader(mut from)) => {
                from.read_records(rows, levels, None, to)
            }
            (Self::Flags(to), ColumnReader::BoolColumnReader(mut from)) => {
                from.read_records(rows, levels, None, to)
            }
            (Self::Texts(to), ColumnReader::ByteArrayColumnReader(mut from)) => {
                from.read_records(rows, levels, None, to)
            }
            _ => Err(other_columns()),
        }
    }
}

fn other_columns() -> ParquetError {
    ParquetError::General("its columns are others".into())
}

fn schema(columns: &[Column]) -> Result<TypePtr> {
    let mut fields = Vec::new();
    for group in columns.chunk_by(|one, next| one.group == next.group) {
        let leaves = group.iter().map(leaf).collect::<Result<Vec<_>>>()?;
        match group[0].group {
            "" => fields.extend(leaves),
            name => {
                let needed = if name == END { Repetition::OPTIONAL } else { Repetition::REQUIRED };
                let group = Type::group_type_builder(name).with_repetition(needed).with_fields(leaves);
                fields.push(Arc::new(group.build()?));
            }
        }
    }
    Ok(Arc::new(Type::group_type_builder("members").with_fields(fields).build()?))
}

fn leaf(column: &Column) -> Result<TypePtr> {
    let physical = column.values.physical();
    let is_text = physical == Physical::BYTE_ARRAY;
    let leaf = Type::primitive_type_builder(&column.name, physical)
        .with_logical_type(is_text.then_some(LogicalType::String))
        .with_repetition(Repetition::REQUIRED);
    leaf.build().map(Arc::new)
}

/// Keys of the file metadata: [`Fingerprint::system`], [`Fingerprint::run`] and, of member 0, [`Fingerprint::start`];
/// for readers, the name and the equations of the system.
const SYSTEM: &str = "lagrange.fingerprint.system";
const RUN: &str = "lagrange.fingerprint.run";
const FIRST: &str = "lagrange.fingerprint.first";
const NAME: &str = "lagrange.system";
const EQUATIONS: &str = "lagrange.equations";

/// Writes these columns to a file. `has_end` is true for the rows whose member has a motion. `first` is the fingerprint
/// of member 0.
pub(super) fn write(
    to: impl Write + Send,
    columns: &[Column],
    has_end: &[bool],
    first: Fingerprint,
    [name, equations]: [&str; 2],
) -> Result<()> {
    let head = [
        (SYSTEM, first.system.to_string()),
        (RUN, first.run.to_string()),
        (FIRST, first.start.to_string()),
        (NAME, name.into()),
        (EQUATIONS, equations.into()),
    ];
    let head = head.into_iter().map(|(key, value)| KeyValue::new(key.into(), value)).collect();
    let properties = WriterProperties::builder().set_key_value_metadata(Some(head)).build();
    let mut writer = SerializedFileWriter::new(to, schema(columns)?, Arc::new(properties))?;
    let mut group = writer.next_row_group()?;
    let levels: Vec<i16> = has_end.iter().map(|has| i16::from(*has)).collect();
    columns.iter().try_for_each(|column| write_column(&mut group, column, &levels))?;
    group.close()?;
    writer.close().map(drop)
}

fn write_column<W: Write + Send>(
    group: &mut SerializedRowGroupWriter<'_, W>,
    column: &Column,
    levels: &[i16],
) -> Result<()> {
    let mut writer = group.next_column()?.ok_or_else(other_columns)?;
    column.values.write(writer.untyped(), (column.group == END).then_some(levels))?;
    writer.close()
}

/// Reason why a file cannot be read or written.
#[derive(Debug)]
pub(super) enum FileFault {
    /// The file is incomplete, or writing failed: it was cut off, the disk is full.
    Damaged(String),
    /// The file cannot be opened, or it is complete but belongs to another table.
    Other(String),
}

impl From<ParquetError> for FileFault {
    fn from(error: ParquetError) -> Self {
        Self::Damaged(error.to_string())
    }
}

impl From<std::io::Error> for FileFault {
    fn from(error: std::io::Error) -> Self {
        Self::Damaged(error.to_string())
    }
}

/// Reads the fingerprint of member 0 from the metadata of a file. `columns` holds the expected schema.
fn first(reader: &SerializedFileReader<File>, columns: &[Column]) -> Result<Fingerprint, FileFault> {
    let head = reader.metadata().file_metadata();
    if head.schema() != &*schema(columns)? {
        return Err(FileFault::Other("its columns are others".into()));
    }
    let number = |key: &str| {
        let entry = head.key_value_metadata()?.iter().find(|entry| entry.key == key)?;
        entry.value.as_ref()?.parse().ok()
    };
    match (number(SYSTEM), number(RUN), number(FIRST)) {
        (Some(system), Some(run), Some(start)) => Ok(Fingerprint { system, run, start }),
        _ => Err(FileFault::Other("it does not say of which run it is".into())),
    }
}

/// Reads a file: its columns, a flag per row that tells whether the member has a motion, and the fingerprint of member
/// 0. `columns` holds the expected schema, without rows.
pub(super) fn read(
    file: File,
    mut columns: Vec<Column>,
) -> Result<(Vec<Column>, Vec<bool>, Fingerprint), FileFault> {
    let reader = SerializedFileReader::new(file)?;
    let first = first(&reader, &columns)?;
    let mut levels = Vec::new();
    for group in 0..reader.num_row_groups() {
        read_group(&*reader.get_row_group(group)?, &mut columns, &mut levels)?;
    }
    let has_end = levels.into_iter().map(|level: i16| level > 0).collect();
    Ok((columns, has_end, first))
}

fn read_group(from: &dyn RowGroupReader, columns: &mut [Column], levels: &mut Vec<i16>) -> Result<()> {
    let rows = usize::try_from(from.metadata().num_rows()).map_err(|_| other_columns())?;
    let mut of_group = Vec::new();
    for (k, column) in columns.iter_mut().enumerate() {
        of_group.clear();
        let (read, ..) = column.values.read(from.get_column_reader(k)?, rows, &mut of_group)?;
        if read != rows {
            return Err(ParquetError::General("it has fewer rows than it says".into()));
        }
        if column.group == END && column.name == "t" {
            levels.extend(&of_group);
        }
    }
    Ok(())
}
