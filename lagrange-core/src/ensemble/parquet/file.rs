//! Reads and writes one Parquet file of a table, as columns of numbers and texts.

use std::fs::File;
use std::io::Write;
use std::sync::Arc;

use parquet::basic::{ConvertedType, LogicalType, Repetition, Type as Physical};
use parquet::column::reader::ColumnReader;
use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::errors::{ParquetError, Result};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, RowGroupReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::{Type, TypePtr};

use crate::ensemble::fingerprint::Fingerprint;

/// A column of a file.
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
/// List of the samples of a member.
pub(super) const SAMPLES: &str = "samples";
/// List of the crossings of a member.
pub(super) const CROSSINGS: &str = "crossings";
/// Groups with any number of entries in a row; [`END`] has at most one.
const GROUPS: [&str; 3] = [END, SAMPLES, CROSSINGS];

/// Columns of a file, and how many entries each row has in the groups [`END`], [`SAMPLES`] and [`CROSSINGS`].
pub(super) struct Sheet {
    pub(super) columns: Vec<Column>,
    pub(super) counts: [Vec<usize>; GROUPS.len()],
}

impl Sheet {
    /// Values of the columns of a group.
    pub(super) fn group(&self, name: &str) -> Vec<&Values> {
        self.columns.iter().filter(|column| column.group == name).map(|column| &column.values).collect()
    }
}

/// Definition and repetition levels of the entries of a group: a row without an entry has the definition level 0, and the
/// entries of a row after the first have the repetition level 1.
fn levels(counts: &[usize]) -> (Vec<i16>, Vec<i16>) {
    let of_row = |count: &usize| {
        let count = *count;
        (0..count.max(1)).map(move |k| (i16::from(count > 0), i16::from(k > 0)))
    };
    counts.iter().flat_map(of_row).unzip()
}

/// Numbers of entries of the rows with these levels. There are no repetition levels where a row has at most one entry.
fn counts(defined: &[i16], repeated: &[i16]) -> Vec<usize> {
    let mut counts = Vec::new();
    for (k, defined) in defined.iter().enumerate() {
        match (repeated.get(k), counts.last_mut()) {
            (Some(1..), Some(count)) => *count += 1,
            _ => counts.push(usize::from(*defined > 0)),
        }
    }
    counts
}

impl Values {
    pub(super) fn count(&self, place: usize) -> Option<usize> {
        if let Self::Integers(values) = self { values.get(place)?.to_owned().try_into().ok() } else { None }
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

    fn write(
        &self,
        to: &mut ColumnWriter<'_>,
        defined: Option<&[i16]>,
        repeated: Option<&[i16]>,
    ) -> Result<usize> {
        match (self, to) {
            (Self::Integers(values), ColumnWriter::Int64ColumnWriter(to)) => {
                to.write_batch(values, defined, repeated)
            }
            (Self::Numbers(values), ColumnWriter::DoubleColumnWriter(to)) => {
                to.write_batch(values, defined, repeated)
            }
            (Self::Flags(values), ColumnWriter::BoolColumnWriter(to)) => {
                to.write_batch(values, defined, repeated)
            }
            (Self::Texts(values), ColumnWriter::ByteArrayColumnWriter(to)) => {
                to.write_batch(values, defined, repeated)
            }
            _ => Err(other_columns()),
        }
    }

    /// Appends the next `rows` rows of a column, with their definition and repetition levels.
    fn read(
        &mut self,
        from: ColumnReader,
        rows: usize,
        (defined, repeated): (&mut Vec<i16>, &mut Vec<i16>),
    ) -> Result<(usize, usize, usize)> {
        let (defined, repeated) = (Some(defined), Some(repeated));
        match (self, from) {
            (Self::Integers(to), ColumnReader::Int64ColumnReader(mut from)) => {
                from.read_records(rows, defined, repeated, to)
            }
            (Self::Numbers(to), ColumnReader::DoubleColumnReader(mut from)) => {
                from.read_records(rows, defined, repeated, to)
            }
            (Self::Flags(to), ColumnReader::BoolColumnReader(mut from)) => {
                from.read_records(rows, defined, repeated, to)
            }
            (Self::Texts(to), ColumnReader::ByteArrayColumnReader(mut from)) => {
                from.read_records(rows, defined, repeated, to)
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
            name @ (SAMPLES | CROSSINGS) => fields.push(list(name, leaves)?),
            name => {
                let needed = if name == END { Repetition::OPTIONAL } else { Repetition::REQUIRED };
                fields.push(struct_of(name, needed, leaves)?);
            }
        }
    }
    Ok(Arc::new(Type::group_type_builder("members").with_fields(fields).build()?))
}

fn struct_of(name: &str, needed: Repetition, fields: Vec<TypePtr>) -> Result<TypePtr> {
    Type::group_type_builder(name).with_repetition(needed).with_fields(fields).build().map(Arc::new)
}

/// A list of structs, in the three levels that the format prescribes.
fn list(name: &str, fields: Vec<TypePtr>) -> Result<TypePtr> {
    let element = struct_of("element", Repetition::REQUIRED, fields)?;
    let entries = struct_of("list", Repetition::REPEATED, vec![element])?;
    let list = Type::group_type_builder(name)
        .with_repetition(Repetition::REQUIRED)
        .with_logical_type(Some(LogicalType::List))
        .with_converted_type(ConvertedType::LIST)
        .with_fields(vec![entries]);
    list.build().map(Arc::new)
}

/// Names of the fields of the list [`SAMPLES`] in this schema.
fn fields_of_samples(schema: &Type) -> Option<Vec<String>> {
    let inner = |group: &Type, name: &str| {
        let fields = if group.is_group() { group.get_fields() } else { &[] };
        fields.iter().find(|field| field.name() == name).cloned()
    };
    let element = inner(&*inner(&*inner(schema, SAMPLES)?, "list")?, "element")?;
    Some(element.get_fields().iter().map(|field| field.name().to_string()).collect())
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

/// Writes these columns to a file. `first` is the fingerprint of member 0.
pub(super) fn write(
    to: impl Write + Send,
    Sheet { columns, counts }: &Sheet,
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
    let levels = counts.each_ref().map(|counts| levels(counts));
    for column in columns {
        let of_group = GROUPS.iter().position(|group| *group == column.group).map(|place| &levels[place]);
        let mut writer = group.next_column()?.ok_or_else(other_columns)?;
        let (defined, repeated) =
            (of_group.map(|(defined, _)| &defined[..]), of_group.map(|(_, repeated)| &repeated[..]));
        column.values.write(writer.untyped(), defined, repeated)?;
        writer.close()?;
    }
    group.close()?;
    writer.close().map(drop)
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

/// Reads a file, of its columns those that `is_wanted` chooses, and the fingerprint of member 0. `columns` makes the
/// columns, without rows, from the fields of the samples.
pub(super) fn read(
    file: File,
    columns: impl FnOnce(Vec<String>) -> Vec<Column>,
    is_wanted: impl Fn(&Column) -> bool,
) -> Result<(Sheet, Fingerprint), FileFault> {
    let reader = SerializedFileReader::new(file)?;
    let fields = fields_of_samples(reader.metadata().file_metadata().schema());
    let columns = columns(fields.unwrap_or_default());
    let first = first(&reader, &columns)?;
    let mut sheet = Sheet { columns, counts: Default::default() };
    for group in 0..reader.num_row_groups() {
        read_group(&*reader.get_row_group(group)?, &mut sheet, &is_wanted)?;
    }
    Ok((sheet, first))
}

fn read_group(
    from: &dyn RowGroupReader,
    sheet: &mut Sheet,
    is_wanted: impl Fn(&Column) -> bool,
) -> Result<()> {
    let rows = usize::try_from(from.metadata().num_rows()).map_err(|_| other_columns())?;
    let (mut defined, mut repeated) = (Vec::new(), Vec::new());
    let wanted = sheet.columns.iter_mut().enumerate().filter(|(_, column)| is_wanted(column));
    for (k, column) in wanted {
        defined.clear();
        repeated.clear();
        let levels = (&mut defined, &mut repeated);
        let (read, ..) = column.values.read(from.get_column_reader(k)?, rows, levels)?;
        if read != rows {
            return Err(ParquetError::General("it has fewer rows than it says".into()));
        }
        let group = GROUPS.iter().position(|group| *group == column.group && column.name == "t");
        if let Some(group) = group {
            sheet.counts[group].extend(counts(&defined, &repeated));
        }
    }
    Ok(())
}
