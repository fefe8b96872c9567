//! The macros that declare tables.

/// Declares a struct as a table: every field is a key with the kind of value after `=`, whose declaration may name keys before it.
///
/// A path after `checked by` names what checks keys against each other; fields of `also` are no keys.
#[macro_export]
macro_rules! declare {
    (
        $(#[doc = $doc:literal])*
        $(#[derive($($Derived:ident),*)])?
        pub struct $Name:ident $(, checked by $check:path)? {
            $( $(#[doc = $key_doc:literal])* pub $key:ident : $Type:ty = $kind:expr, )*
        }
        $( also { $( $(#[doc = $also_doc:literal])* pub $also:ident : $Also:ty, )* } )?
    ) => {
        $(#[doc = $doc])*
        #[derive(Debug, Clone, PartialEq $($(, $Derived)*)?)]
        pub struct $Name {
            $( $(#[doc = $key_doc])* pub $key: $Type, )*
            $( $( $(#[doc = $also_doc])* pub $also: $Also, )* )?
        }

        impl $crate::Blank for $Name {
            fn blank() -> Self {
                $Name {
                    $( $key: $crate::Blank::blank(), )*
                    $( $( $also: Default::default(), )* )?
                }
            }
        }

        impl Default for $Name {
            fn default() -> Self {
                $crate::with_defaults(<$Name as $crate::Blank>::blank())
            }
        }

        impl $crate::Table for $Name {
            fn visit(&mut self, visitor: &mut dyn $crate::Visitor) {
                #[allow(unused_variables)]
                let $Name { $($key,)* $( $($also,)* )? } = self;
                $( {
                    let key = $crate::Key { name: stringify!($key), doc: concat!($($key_doc),*) };
                    $crate::Kind::visit($kind, key, $key, visitor);
                } )*
            }

            $( fn check(&self, report: &mut $crate::Report) {
                $check(self, report)
            } )?

            fn doc(&self) -> &'static str {
                concat!($($doc),*)
            }
        }
    };
}

/// Declares an enum of tables. `by tag "key"`: the word at that key says which; `by presence`: which of the words is a key.
#[macro_export]
macro_rules! variants {
    (
        $(#[doc = $doc:literal])*
        $(#[derive($($Derived:ident),*)])?
        pub enum $Name:ident by $how:ident $($tag:literal)? $(or $default:literal)? $(, checked by $check:path)? {
            $(
                $(#[doc = $word_doc:literal])*
                $Variant:ident $word:literal {
                    $( $(#[doc = $key_doc:literal])* $key:ident : $Type:ty = $kind:expr, )*
                }
            )*
        }
    ) => {
        $(#[doc = $doc])*
        #[derive(Debug, Clone, PartialEq $($(, $Derived)*)?)]
        pub enum $Name {
            $( $(#[doc = $word_doc])* $Variant { $( $(#[doc = $key_doc])* $key: $Type, )* }, )*
        }

        impl $Name {
            const EACH: &'static [(&'static str, &'static str)] = &[$(($word, concat!($($word_doc),*))),*];

            fn blank_of(k: usize) -> Self {
                let all: &[fn() -> Self] = &[
                    $( || $Name::$Variant { $( $key: $crate::Blank::blank(), )* } ),*
                ];
                all[k]()
            }

            /// The word that selects the variant.
            pub fn word(&self) -> &'static str {
                match self {
                    $( $Name::$Variant { .. } => $word, )*
                }
            }
        }

        impl $crate::Blank for $Name {
            fn blank() -> Self {
                $Name::blank_of(0)
            }
        }

        impl $crate::Table for $Name {
            fn visit(&mut self, visitor: &mut dyn $crate::Visitor) {
                let index = |this: &Self| Self::EACH.iter().position(|(word, _)| *word == this.word()).unwrap_or(0);
                let default: Option<&str> = [$(Some($default),)? None][0];
                let variants = $crate::Variants {
                    by: $crate::variants!(@by $how $($tag)?),
                    each: Self::EACH,
                    default: default.and_then(|default| Self::EACH.iter().position(|(word, _)| *word == default)),
                };
                let current = index(self);
                visitor.variants(&variants, current, &mut |k, visitor| {
                    if k != index(self) {
                        *self = Self::blank_of(k);
                    }
                    match self {
                        $( $Name::$Variant { $($key,)* } => { $(
                            let about = $crate::Key { name: stringify!($key), doc: concat!($($key_doc),*) };
                            $crate::Kind::visit($kind, about, $key, visitor);
                        )* } )*
                    }
                });
            }

            $( fn check(&self, report: &mut $crate::Report) {
                $check(self, report)
            } )?

            fn doc(&self) -> &'static str {
                concat!($($doc),*)
            }
        }
    };
    (@by tag $tag:literal) => { $crate::By::Tag($tag) };
    (@by presence) => { $crate::By::Presence };
}

/// Declares an enum of words, the first of which is the blank value.
#[macro_export]
macro_rules! choices {
    (
        $(#[doc = $doc:literal])*
        pub enum $Name:ident { $( $(#[doc = $word_doc:literal])* $Variant:ident = $word:literal, )* }
    ) => {
        $(#[doc = $doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum $Name { $( $(#[doc = $word_doc])* $Variant, )* }

        $crate::choices!(@words $Name { $( $Variant = $word, concat!($($word_doc),*), )* });
    };
    (@words $Name:ident { $( $Variant:ident = $word:literal, $doc:expr, )* }) => {
        impl $Name {
            /// The word that stands for it in a case.
            pub fn word(self) -> &'static str {
                match self {
                    $( $Name::$Variant => $word, )*
                }
            }
        }

        impl $crate::Blank for $Name {
            fn blank() -> Self {
                [$($Name::$Variant),*][0]
            }
        }

        impl Default for $Name {
            fn default() -> Self {
                $crate::Blank::blank()
            }
        }

        impl $crate::Value for $Name {
            fn read(
                value: &$crate::toml::de::DeValue,
                _: &$crate::Units,
                _: usize,
            ) -> Result<Self, String> {
                $crate::raw::word_of(value, &[$(($word, $Name::$Variant)),*])
            }

            fn to_toml(&self) -> Option<$crate::toml::Value> {
                Some($crate::toml::Value::String(self.word().into()))
            }

            fn form() -> $crate::Form {
                $crate::Form::Choice(&[$(($word, $doc)),*])
            }
        }
    };
}
