//! Protobuf messages declared once: the `message!` tables give the struct that is encoded *and* the descriptor a reader
//! decodes by, comments and units included, so that no `protoc` is needed and the two cannot differ.

mod foxglove;
mod impact;
mod state;

pub(super) use foxglove::{FrameTransform, FrameTransforms, Quaternion, Timestamp, Vector3};
pub(super) use impact::Impact;
pub(super) use state::State;

use prost::Message;
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::source_code_info::Location;
use prost_types::{DescriptorProto, FieldDescriptorProto, FileDescriptorProto, FileDescriptorSet, SourceCodeInfo};

/// Declares a message, alone in its file: package, file name, then `number name: [wire options of prost] type, "meaning";`.
macro_rules! message {
    ($package:literal $file:literal $(#[doc = $about:literal])+ $name:ident {
        $($number:tt $field:ident: [$($wire:tt)+] $type:ty, $doc:literal;)*
    }) => {
        $(#[doc = $about])+
        #[derive(Clone, PartialEq, ::prost::Message)]
        pub(crate) struct $name {
            $(#[doc = $doc] #[prost($($wire)+, tag = $number)] pub(crate) $field: $type,)*
        }

        impl $crate::record::proto::Described for $name {
            const PACKAGE: &'static str = $package;
            const NAME: &'static str = stringify!($name);
            const FILE: &'static str = $file;
            const ABOUT: &'static str = concat!($($about, "\n"),+);

            fn fields() -> Vec<$crate::record::proto::Field> {
                vec![$($crate::record::proto::Field::of::<$type>($number, stringify!($field), $doc)),*]
            }
        }
    };
}
use message;

/// A message that knows its own schema.
pub(super) trait Described: Message + Sized {
    const PACKAGE: &'static str;
    const NAME: &'static str;
    const FILE: &'static str;
    const ABOUT: &'static str;

    fn fields() -> Vec<Field>;

    fn full_name() -> String {
        format!("{}.{}", Self::PACKAGE, Self::NAME)
    }

    /// The encoded `FileDescriptorSet` of the message and all it needs, dependencies first.
    fn schema() -> Vec<u8> {
        let mut file = Vec::new();
        collect::<Self>(&mut file);
        FileDescriptorSet { file }.encode_to_vec()
    }
}

/// What a field of a message may be.
pub(super) trait FieldType {
    const TYPE: Type;
    const LABEL: Label = Label::Optional;
    const MESSAGE: Option<Nested> = None;
}

/// The message a field holds.
#[derive(Clone, Copy)]
pub(super) struct Nested {
    full_name: fn() -> String,
    file: &'static str,
    collect: fn(&mut Vec<FileDescriptorProto>),
}

impl Nested {
    const fn of<M: Described>() -> Self {
        Self { full_name: M::full_name, file: M::FILE, collect: collect::<M> }
    }
}

macro_rules! scalar_fields {
    ($($type:ty => $wire:ident),*) => { $(impl FieldType for $type { const TYPE: Type = Type::$wire; })* };
}
scalar_fields!(f64 => Double, bool => Bool, i32 => Int32, i64 => Int64, String => String);

impl<M: Described> FieldType for Option<M> {
    const TYPE: Type = Type::Message;
    const MESSAGE: Option<Nested> = Some(Nested::of::<M>());
}

impl<M: Described> FieldType for Vec<M> {
    const TYPE: Type = Type::Message;
    const LABEL: Label = Label::Repeated;
    const MESSAGE: Option<Nested> = Some(Nested::of::<M>());
}

/// A field as its `message!` table declares it.
pub(super) struct Field {
    descriptor: FieldDescriptorProto,
    message: Option<Nested>,
    doc: &'static str,
}

impl Field {
    fn of<T: FieldType>(number: i32, name: &str, doc: &'static str) -> Self {
        let mut descriptor = FieldDescriptorProto {
            name: Some(name.to_owned()),
            number: Some(number),
            type_name: T::MESSAGE.map(|m| format!(".{}", (m.full_name)())),
            ..FieldDescriptorProto::default()
        };
        descriptor.set_type(T::TYPE);
        descriptor.set_label(T::LABEL);
        Self { descriptor, message: T::MESSAGE, doc }
    }
}

/// Appends the files of all messages that `M` needs, then its own, each once.
fn collect<M: Described>(files: &mut Vec<FileDescriptorProto>) {
    if files.iter().any(|f| f.name() == M::FILE) {
        return;
    }
    let fields = M::fields();
    let mut dependency: Vec<String> = Vec::new();
    for nested in fields.iter().filter_map(|f| f.message) {
        (nested.collect)(files);
        if !dependency.iter().any(|d| d == nested.file) {
            dependency.push(nested.file.to_owned());
        }
    }
    // Paths into a FileDescriptorProto: 4, 0 is its first message, and 2, i that message's i-th field.
    let mut location = vec![comment(vec![4, 0], M::ABOUT)];
    location.extend((0..).zip(&fields).map(|(i, f)| comment(vec![4, 0, 2, i], f.doc)));
    let message = DescriptorProto {
        name: Some(M::NAME.to_owned()),
        field: fields.into_iter().map(|f| f.descriptor).collect(),
        ..DescriptorProto::default()
    };
    files.push(FileDescriptorProto {
        name: Some(M::FILE.to_owned()),
        package: Some(M::PACKAGE.to_owned()),
        dependency,
        message_type: vec![message],
        source_code_info: Some(SourceCodeInfo { location }),
        syntax: Some("proto3".to_owned()),
        ..FileDescriptorProto::default()
    });
}

fn comment(path: Vec<i32>, text: &str) -> Location {
    // There is no source text for the span to point into.
    Location { path, span: vec![0, 0, 0], leading_comments: Some(text.to_owned()), ..Location::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn files(schema: &[u8]) -> Vec<FileDescriptorProto> {
        FileDescriptorSet::decode(schema).unwrap().file
    }

    #[test]
    fn schema_defines_every_message_before_it_is_used_and_only_once() {
        for file in [files(&FrameTransforms::schema()), files(&State::schema()), files(&Impact::schema())] {
            let mut names: Vec<&str> = Vec::new();
            let mut types: Vec<String> = Vec::new();
            for f in &file {
                assert!(f.dependency.iter().all(|d| names.contains(&d.as_str())), "{} comes too early", f.name());
                assert!(!names.contains(&f.name()), "{} comes twice", f.name());
                names.push(f.name());
                let message = &f.message_type[0];
                for field in message.field.iter().filter(|field| field.r#type() == Type::Message) {
                    assert!(types.iter().any(|t| t == field.type_name()), "{} is unknown", field.type_name());
                }
                types.push(format!(".{}.{}", f.package(), message.name()));
            }
        }
    }

    #[test]
    fn foxglove_messages_have_their_official_field_numbers() {
        let official = [
            ("Timestamp", vec![("seconds", 1), ("nanos", 2)]),
            ("Vector3", vec![("x", 1), ("y", 2), ("z", 3)]),
            ("Quaternion", vec![("x", 1), ("y", 2), ("z", 3), ("w", 4)]),
            (
                "FrameTransform",
                vec![
                    ("timestamp", 1),
                    ("parent_frame_id", 2),
                    ("child_frame_id", 3),
                    ("translation", 4),
                    ("rotation", 5),
                ],
            ),
            ("FrameTransforms", vec![("transforms", 1)]),
        ];
        let file = files(&FrameTransforms::schema());
        assert_eq!(file.len(), official.len());
        for (f, (name, fields)) in file.iter().zip(official) {
            let message = &f.message_type[0];
            assert_eq!(message.name(), name);
            assert_eq!(message.field.iter().map(|f| (f.name(), f.number())).collect::<Vec<_>>(), fields);
        }
    }
}
