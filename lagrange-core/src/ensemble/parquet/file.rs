//! Reads and writes one Parquet file of a table: rows of serde as columns.

use std::fs::File;
use std::io::Write;
use std::sync::Arc;

use parquet::basic::{ConvertedType, LogicalType, Repetition, Type as Physical};
use parquet::column::writer::ColumnWriter;
use parquet::errors::{ParquetError, Result};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::record::Field;
use parquet::schema::types::{Type, TypePtr};
use serde::de::value::{Error as ReadError, MapDeserializer, SeqDeserializer};
use serde::de::{DeserializeOwned, Deserializer, Error as _, IntoDeserializer, Visitor};
use serde::{Deserialize, Serialize, forward_to_deserialize_any};
use serde_json::Value;

use crate::ensemble::fingerprint::Fingerprint;
use crate::ensemble::limits::ROWS_IN_GROUP;
use crate::ensemble::line::Number;
use crate::ensemble::names::ColumnNames;

/// Schema of rows with the states and quantities `names` and these parameters: the fields of a
/// [`MemberRow`](crate::ensemble::MemberRow), the start and the parameters of the member.
pub(super) fn schema(names: &ColumnNames, parameters: &[&str]) -> Result<TypePtr> {
    use Physical::{BOOLEAN, BYTE_ARRAY, INT64};
    let required = Repetition::REQUIRED;
    let integers = |names: &[&str]| leaves(names, INT64);
    let state = |name, repetition| group(name, repetition, numbers(&names.state)?);
    let crossing = [
        leaves(&["event"], BYTE_ARRAY)?,
        integers(&["index", "count"])?,
        leaves(&["rising"], BOOLEAN)?,
        vec![state("state", required)?],
    ];
    let statistics =
        [integers(&["accepted", "rejected", "evaluations"])?, leaves(&["multipliers_are_unique"], BOOLEAN)?];
    let mut fields = integers(&["member"])?;
    fields.push(group("fingerprint", required, integers(&["system", "run", "start"])?)?);
    fields.extend(leaves(&["ending"], BYTE_ARRAY)?);
    fields.push(state("start", required)?);
    // The format has no groups without fields.
    if !parameters.is_empty() {
        fields.push(group("parameters", required, numbers(parameters)?)?);
    }
    fields.push(state("end", Repetition::OPTIONAL)?);
    fields.push(group("statistics", required, statistics.concat())?);
    fields.push(list("samples", [numbers(&names.state)?, numbers(&names.quantities)?].concat())?);
    fields.push(list("crossings", crossing.concat())?);
    group("members", required, fields)
}

fn numbers<S: AsRef<str>>(names: &[S]) -> Result<Vec<TypePtr>> {
    leaves(names, Physical::DOUBLE)
}

fn leaves<S: AsRef<str>>(names: &[S], physical: Physical) -> Result<Vec<TypePtr>> {
    let is_text = physical == Physical::BYTE_ARRAY;
    let leaf = |name: &S| {
        let leaf = Type::primitive_type_builder(name.as_ref(), physical)
            .with_logical_type(is_text.then_some(LogicalType::String))
            .with_repetition(Repetition::REQUIRED);
        leaf.build().map(Arc::new)
    };
    names.iter().map(leaf).collect()
}

fn group(name: &str, repetition: Repetition, fields: Vec<TypePtr>) -> Result<TypePtr> {
    Type::group_type_builder(name).with_repetition(repetition).with_fields(fields).build().map(Arc::new)
}

/// A list of structs, in the three levels that the format prescribes.
fn list(name: &str, fields: Vec<TypePtr>) -> Result<TypePtr> {
    let element = group("element", Repetition::REQUIRED, fields)?;
    let list = Type::group_type_builder(name)
        .with_repetition(Repetition::REQUIRED)
        .with_logical_type(Some(LogicalType::List))
        .with_converted_type(ConvertedType::LIST)
        .with_fields(vec![group("list", Repetition::REPEATED, vec![element])?]);
    list.build().map(Arc::new)
}

/// Key of the file metadata: the fingerprint of member 0 as JSON.
const FIRST: &str = "lagrange.first";
/// Keys for readers: the name and the equations of the system.
const NAME: &str = "lagrange.system";
const EQUATIONS: &str = "lagrange.equations";

/// Writes these rows to a file. `first` is the fingerprint of member 0.
pub(super) fn write<R: Serialize>(
    to: impl Write + Send,
    schema: TypePtr,
    rows: impl Iterator<Item = R>,
    first: Fingerprint,
    [name, equations]: [&str; 2],
) -> Result<()> {
    let first = serde_json::to_string(&first).map_err(|_| other_columns())?;
    let head = [(FIRST, first), (NAME, name.into()), (EQUATIONS, equations.into())];
    let head = head.into_iter().map(|(key, value)| KeyValue::new(key.into(), value)).collect();
    let properties = WriterProperties::builder().set_key_value_metadata(Some(head)).build();
    let mut writer = SerializedFileWriter::new(to, schema, Arc::new(properties))?;
    let mut rows = rows.map(|row| serde_json::to_value(row).map_err(|_| other_columns())).peekable();
    while rows.peek().is_some() {
        write_group(&mut writer, &rows.by_ref().take(ROWS_IN_GROUP).collect::<Result<Vec<_>>>()?)?;
    }
    writer.close().map(drop)
}

fn write_group(to: &mut SerializedFileWriter<impl Write + Send>, rows: &[Value]) -> Result<()> {
    let columns = to.schema_descr().columns().to_vec();
    let mut group = to.next_row_group()?;
    for column in columns {
        let mut entries = ColumnEntries::default();
        rows.iter().for_each(|row| entries.push(row, column.path().parts(), 0));
        let mut writer = group.next_column()?.ok_or_else(other_columns)?;
        entries.write(writer.untyped())?;
        writer.close()?;
    }
    group.close().map(drop)
}

fn other_columns() -> ParquetError {
    ParquetError::General("its columns are others".into())
}

/// Entries of a column.
#[derive(Default)]
struct ColumnEntries<'v> {
    values: Vec<&'v Value>,
    /// Definition levels: 0 for a row without an entry, because its `end` is null or its list is empty.
    defined: Vec<i16>,
    /// Repetition levels: 1 for the entries of a list after the first.
    repeated: Vec<i16>,
}

impl<'v> ColumnEntries<'v> {
    /// Appends the entries of a value under this path of names.
    fn push(&mut self, value: &'v Value, path: &[String], repeated: i16) {
        match (value, path) {
            (Value::Object(fields), [name, rest @ ..]) => {
                self.push(fields.get(name).unwrap_or(&Value::Null), rest, repeated);
            }
            // Below a list, the path has the names `list` and `element`.
            (Value::Array(elements), [_, _, rest @ ..]) if !elements.is_empty() => {
                elements
                    .iter()
                    .enumerate()
                    .for_each(|(k, element)| self.push(element, rest, i16::from(k > 0)));
            }
            (value, rest) => {
                let is_defined = rest.is_empty();
                self.values.extend(is_defined.then_some(value));
                self.defined.push(is_defined.into());
                self.repeated.push(repeated);
            }
        }
    }

    fn write(&self, to: &mut ColumnWriter<'_>) -> Result<usize> {
        let levels = (Some(&self.defined[..]), Some(&self.repeated[..]));
        match to {
            ColumnWriter::Int64ColumnWriter(to) => {
                to.write_batch(&self.typed(Value::as_i64)?, levels.0, levels.1)
            }
            ColumnWriter::BoolColumnWriter(to) => {
                to.write_batch(&self.typed(Value::as_bool)?, levels.0, levels.1)
            }
            ColumnWriter::DoubleColumnWriter(to) => {
                let number = |value: &Value| Number::deserialize(value).ok().map(|Number(x)| x);
                to.write_batch(&self.typed(number)?, levels.0, levels.1)
            }
            ColumnWriter::ByteArrayColumnWriter(to) => {
                to.write_batch(&self.typed(|value| value.as_str().map(Into::into))?, levels.0, levels.1)
            }
            _ => Err(other_columns()),
        }
    }

    fn typed<V>(&self, read: impl Fn(&Value) -> Option<V>) -> Result<Vec<V>> {
        self.values.iter().map(|value| read(value).ok_or_else(other_columns)).collect()
    }
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

/// Reads the fingerprint of member 0 from the metadata of a file.
pub(super) fn first(reader: &SerializedFileReader<File>) -> Result<Fingerprint, FileFault> {
    let head = reader.metadata().file_metadata().key_value_metadata();
    let entry = head.into_iter().flatten().find(|entry| entry.key == FIRST);
    let first = entry.and_then(|entry| serde_json::from_str(entry.value.as_ref()?).ok());
    first.ok_or(FileFault::Other("it does not say of which run it is".into()))
}

/// Rows of a file; `fields` chooses fields by name.
pub(super) fn rows<R: DeserializeOwned>(
    reader: &SerializedFileReader<File>,
    fields: impl Fn(&str) -> bool,
) -> Result<impl Iterator<Item = Result<R, FileFault>>, FileFault> {
    let all = reader.metadata().file_metadata().schema();
    let wanted = all.get_fields().iter().filter(|field| fields(field.name())).cloned().collect();
    let wanted = Type::group_type_builder(all.name()).with_fields(wanted).build()?;
    let read = |row| {
        R::deserialize(RowEntry(&Field::Group(row))).map_err(|error| FileFault::Other(error.to_string()))
    };
    Ok(reader.get_row_iter(Some(wanted))?.map(move |row| read(row?)))
}

/// An entry of a row, which serde reads.
struct RowEntry<'f>(&'f Field);

impl<'de> Deserializer<'de> for RowEntry<'de> {
    type Error = ReadError;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        match self.0 {
            Field::Bool(flag) => visitor.visit_bool(*flag),
            Field::Long(integer) => visitor.visit_i64(*integer),
            Field::Double(number) => visitor.visit_f64(*number),
            Field::Str(text) => visitor.visit_str(text),
            Field::Group(row) => {
                let fields = row.get_column_iter().map(|(name, field)| (name.as_str(), RowEntry(field)));
                visitor.visit_map(MapDeserializer::new(fields))
            }
            Field::ListInternal(list) => {
                visitor.visit_seq(SeqDeserializer::new(list.elements().iter().map(RowEntry)))
            }
            _ => Err(ReadError::custom(other_columns())),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        if matches!(self.0, Field::Null) { visitor.visit_none() } else { visitor.visit_some(self) }
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf unit unit_struct newtype_struct seq tuple
        tuple_struct map struct enum identifier ignored_any
    }
}

impl<'de> IntoDeserializer<'de> for RowEntry<'de> {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}
