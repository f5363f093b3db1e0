//! Enums whose variants have names.

/// Declares an enum whose variants have names in data. Serde reads and writes these names, and `name` returns
/// a variant's name.
#[doc(hidden)]
#[macro_export]
macro_rules! named_enum {
    ($(#[$doc:meta])* pub enum $named:ident { $($(#[$about:meta])* $variant:ident = $name:literal,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[derive(serde::Serialize, serde::Deserialize)]
        pub enum $named { $($(#[$about])* #[serde(rename = $name)] $variant),* }

        impl $named {
            /// All variants, in the order of declaration.
            pub const ALL: [$named; [$($name),*].len()] = [$($named::$variant),*];

            /// Returns the name used in data.
            pub fn name(self) -> &'static str {
                match self { $($named::$variant => $name),* }
            }
        }
    };
}
