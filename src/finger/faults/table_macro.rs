//! The macro that turns the table of faults into the type `FaultKind`: a variant and a [`Description`] for each row.
//!
//! [`Description`]: super::Description

macro_rules! faults {
    ($($number:literal $kind:ident $constant:literal $severity:ident $part:ident $quantity:ident
        $name:literal, $text:literal, $cause:literal, $remedy:literal, [$($action:ident),*];)*) => {
        /// The kind of a fault, a warning or a refusal.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        #[non_exhaustive]
        pub enum FaultKind {
            $(#[doc = concat!($name, ": ", $text, ".")] $kind = $number,)*
        }

        impl FaultKind {
            /// All kinds, in the order of their numbers.
            pub const ALL: &[FaultKind] = &[$(FaultKind::$kind,)*];

            /// Returns the row of the table for this kind.
            pub fn description(self) -> &'static Description {
                match self {
                    $(FaultKind::$kind => &Description {
                        constant: $constant,
                        severity: Severity::$severity,
                        part: PartKind::$part,
                        quantity: Quantity::$quantity,
                        name: $name,
                        text: $text,
                        cause: $cause,
                        remedy: $remedy,
                        actions: &[$(Action::$action),*],
                    },)*
                }
            }
        }
    };
}

pub(super) use faults;
