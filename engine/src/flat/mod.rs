//! Flat data: structs of numbers and number buffers, with each field declared only once.
//!
//! From the list of fields, the macro derives copies that reuse buffers, the size of a copy, and the
//! differences between two values (`pack.rs`).

/// Declares a struct. `copied` fields are copied but left out of diffs. `numbers` and `buffers` are included in
/// diffs. `scratch` buffers are empty between steps. `shared` fields are the same in all states of a level.
macro_rules! flat {
    (
        $(#[$doc:meta])*
        pub(crate) struct $Name:ident {
            copied { $($(#[$copied_doc:meta])* $copied:ident: $Copied:ty,)* }
            numbers { $($(#[$number_doc:meta])* $number:ident: $Number:ty,)* }
            buffers { $($(#[$buffer_doc:meta])* $buffer:ident: $Buffer:ty,)* }
            scratch { $($(#[$scratch_doc:meta])* $scratch:ident: $Scratch:ty,)* }
            shared { $($(#[$shared_doc:meta])* $shared:ident: $Shared:ty,)* }
        }
    ) => {
        $(#[$doc])*
        #[derive(Debug)]
        pub(crate) struct $Name {
            $($(#[$copied_doc])* $copied: $Copied,)*
            $($(#[$number_doc])* $number: $Number,)*
            $($(#[$buffer_doc])* $buffer: Vec<$Buffer>,)*
            $($(#[$scratch_doc])* $scratch: Vec<$Scratch>,)*
            $($(#[$shared_doc])* $shared: Option<std::sync::Arc<$Shared>>,)*
        }

        impl Clone for $Name {
            fn clone(&self) -> $Name {
                $Name {
                    $($copied: self.$copied,)*
                    $($number: self.$number,)*
                    $($buffer: self.$buffer.clone(),)*
                    $($scratch: Vec::new(),)*
                    $($shared: self.$shared.clone(),)*
                }
            }

            #[inline]
            fn clone_from(&mut self, source: &$Name) {
                $(self.$copied = source.$copied;)*
                $(self.$number = source.$number;)*
                $(if source.$buffer.is_empty() {
                    // Many buffers are empty, and even copying an empty buffer would cost a call.
                    self.$buffer.clear();
                } else {
                    self.$buffer.clone_from(&source.$buffer);
                })*
                $(self.$scratch.clear();)*
                // Updating a reference count takes time and is rarely needed.
                $(if self.$shared.as_ref().map(std::sync::Arc::as_ptr)
                    != source.$shared.as_ref().map(std::sync::Arc::as_ptr)
                {
                    self.$shared.clone_from(&source.$shared);
                })*
            }
        }

        impl $Name {
            /// Returns the number of bytes copied when the value is copied.
            pub(crate) fn size_in_bytes(&self) -> usize {
                let buffers = 0 $(+ size_of_val(&self.$buffer[..]))*;
                size_of::<$Name>() + buffers
            }

            /// Writes the differences in numbers and buffers between `self` and `base`.
            pub(crate) fn put_differences(&self, base: &$Name, to: &mut Vec<u8>) {
                $(crate::flat::put_scalar(&self.$number, &base.$number, to);)*
                $(crate::flat::put_buffer(&self.$buffer, &base.$buffer, to);)*
            }

            /// Reads differences that `put_differences` wrote, and applies them to `self`, which must equal the `base`
            /// given there. Advances `from` past the differences.
            pub(crate) fn take_differences(&mut self, from: &mut &[u8]) {
                $(crate::flat::take_scalar(&mut self.$number, from);)*
                $(crate::flat::take_buffer(&mut self.$buffer, from);)*
            }
        }
    };
}

pub(crate) mod pack;

pub(crate) use flat;

pub(crate) fn put_scalar<T: Bytes>(value: &T, base: &T, to: &mut Vec<u8>) {
    let same = value.same(base);
    same.put(to);
    if !same {
        value.put(to);
    }
}

pub(crate) fn take_scalar<T: Bytes>(value: &mut T, from: &mut &[u8]) {
    if !bool::take(from) {
        *value = T::take(from);
    }
}

/// Writes the buffer's length, the entries that differ from `base`, and a distance of 0. Each entry is
/// preceded by its distance from the previous one.
pub(crate) fn put_buffer<T: Bytes>(buffer: &[T], base: &[T], to: &mut Vec<u8>) {
    put_number(buffer.len(), to);
    let mut next = 0;
    for (at, value) in buffer.iter().enumerate() {
        if !base.get(at).is_some_and(|base| value.same(base)) {
            put_number(at + 1 - next, to);
            value.put(to);
            next = at + 1;
        }
    }
    put_number(0, to);
}

pub(crate) fn take_buffer<T: Bytes>(buffer: &mut Vec<T>, from: &mut &[u8]) {
    let length = take_number(from);
    buffer.truncate(length);
    let mut next = 0;
    loop {
        let distance = take_number(from);
        if distance == 0 {
            return;
        }
        next += distance;
        let value = T::take(from);
        match buffer.get_mut(next - 1) {
            Some(old) => *old = value,
            // `put_buffer` writes every entry beyond the end of `base`.
            None => buffer.push(value),
        }
    }
}

/// Writes a number with seven bits per byte, low bits first (LEB128).
fn put_number(mut number: usize, to: &mut Vec<u8>) {
    while number >= 0x80 {
        to.push(number as u8 | 0x80);
        number >>= 7;
    }
    to.push(number as u8);
}

fn take_number(from: &mut &[u8]) -> usize {
    let (mut number, mut shift) = (0, 0);
    loop {
        let byte = u8::take(from);
        number |= usize::from(byte & 0x7F) << shift;
        shift += 7;
        if byte < 0x80 {
            return number;
        }
    }
}

/// A type that can be written as bytes and restored bit for bit.
pub(crate) trait Bytes: Copy {
    fn put(self, to: &mut Vec<u8>);
    fn take(from: &mut &[u8]) -> Self;
    /// Returns `true` if both values have the same bits.
    fn same(&self, other: &Self) -> bool;
}

macro_rules! numbers {
    ($($number:ident)*) => {$(
        impl Bytes for $number {
            fn put(self, to: &mut Vec<u8>) {
                to.extend(self.to_le_bytes());
            }

            fn take(from: &mut &[u8]) -> $number {
                let (head, rest) = from.split_first_chunk().expect("at least as much was written");
                *from = rest;
                $number::from_le_bytes(*head)
            }

            fn same(&self, other: &$number) -> bool {
                self.to_le_bytes() == other.to_le_bytes()
            }
        }
    )*};
}

numbers! { u8 u16 u32 u64 u128 i16 i32 i64 f64 }

impl Bytes for bool {
    fn put(self, to: &mut Vec<u8>) {
        to.push(u8::from(self));
    }

    fn take(from: &mut &[u8]) -> bool {
        u8::take(from) != 0
    }

    fn same(&self, other: &bool) -> bool {
        self == other
    }
}

/// Implements [`Bytes`] for structs, field by field.
macro_rules! bytes_of_fields {
    ($($name:ident { $($field:ident)* })*) => {$(
        impl crate::flat::Bytes for $name {
            fn put(self, to: &mut Vec<u8>) {
                let $name { $($field),* } = self;
                $($field.put(to);)*
            }

            fn take(from: &mut &[u8]) -> $name {
                $name { $($field: crate::flat::Bytes::take(from)),* }
            }

            fn same(&self, other: &$name) -> bool {
                let $name { $($field),* } = self;
                $($field.same(&other.$field))&&*
            }
        }
    )*};
}

pub(crate) use bytes_of_fields;

/// Implements [`Bytes`] for wrappers around one number.
macro_rules! bytes_of_wrapper {
    ($($name:ident)*) => {$(
        impl crate::flat::Bytes for $name {
            fn put(self, to: &mut Vec<u8>) {
                self.0.put(to);
            }

            fn take(from: &mut &[u8]) -> $name {
                $name(crate::flat::Bytes::take(from))
            }

            fn same(&self, other: &$name) -> bool {
                self == other
            }
        }
    )*};
}

pub(crate) use bytes_of_wrapper;

impl<T: Bytes, U: Bytes> Bytes for (T, U) {
    fn put(self, to: &mut Vec<u8>) {
        self.0.put(to);
        self.1.put(to);
    }

    fn take(from: &mut &[u8]) -> (T, U) {
        (T::take(from), U::take(from))
    }

    fn same(&self, other: &(T, U)) -> bool {
        self.0.same(&other.0) && self.1.same(&other.1)
    }
}

impl<T: Bytes, U: Bytes, V: Bytes> Bytes for (T, U, V) {
    fn put(self, to: &mut Vec<u8>) {
        ((self.0, self.1), self.2).put(to);
    }

    fn take(from: &mut &[u8]) -> (T, U, V) {
        let ((one, two), three) = Bytes::take(from);
        (one, two, three)
    }

    fn same(&self, other: &(T, U, V)) -> bool {
        self.0.same(&other.0) && self.1.same(&other.1) && self.2.same(&other.2)
    }
}

impl Bytes for [u64; 2] {
    fn put(self, to: &mut Vec<u8>) {
        (self[0], self[1]).put(to);
    }

    fn take(from: &mut &[u8]) -> [u64; 2] {
        let (one, two) = Bytes::take(from);
        [one, two]
    }

    fn same(&self, other: &[u64; 2]) -> bool {
        self == other
    }
}

impl Bytes for Option<(i32, i32)> {
    fn put(self, to: &mut Vec<u8>) {
        (self.is_some(), self.unwrap_or_default()).put(to);
    }

    fn take(from: &mut &[u8]) -> Self {
        let (is_some, value) = Bytes::take(from);
        Some(value).filter(|_| is_some)
    }

    fn same(&self, other: &Self) -> bool {
        self == other
    }
}
