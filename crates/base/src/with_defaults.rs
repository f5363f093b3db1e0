//! Structs whose fields have defaults.

/// Declares a struct with a default for every field, and implements `Default`.
#[doc(hidden)]
#[macro_export]
macro_rules! with_defaults {
    ($(#[$doc:meta])* $visible:vis struct $named:ident {
        $($(#[$about:meta])* $access:vis $field:ident: $type:ty = $default:expr,)*
    }) => {
        $(#[$doc])*
        $visible struct $named { $($(#[$about])* $access $field: $type,)* }

        impl Default for $named {
            fn default() -> $named {
                $named { $($field: $default,)* }
            }
        }
    };
}
