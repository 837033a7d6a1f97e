//! The macro of the node table: what follows from a row of [`nodes`](super::nodes).

/// Declares nodes. Each row of `Node: Trait in module { … }` is a type of `crate::module` that implements `Trait`; what
/// stands for its type parameters are sources by name, nodes in boxes and kinds chosen at run time. A row has one of
/// four forms:
///
/// - `Type` has no fields;
/// - `Type(field: T, …)` is a tuple struct, whose fields have names for readers;
/// - `Type { field: T, … }` is a struct;
/// - `Type = value: T` is a node already, as `T` is `Type` with kinds chosen at run time.
///
/// From it follow the variant of the enumeration `Node`, the literal that emission prints ([`Node::literal`]) and the
/// value that the interpreted renderer runs ([`Node::boxed`]).
///
/// [`Node::literal`]: super::BsdfNode::literal
/// [`Node::boxed`]: super::BsdfNode::boxed
macro_rules! nodes {
    ($(
        $(#[$doc:meta])*
        $Node:ident: $Trait:ident in $module:ident {
            $(
                $(#[$row_doc:meta])*
                $Type:ident
                $(($($part:ident: $Part:ty),*))?
                $({ $($field:ident: $Field:ty),* $(,)? })?
                $(= $value:ident: $Value:ty)?
            ),* $(,)?
        }
    )*) => {$(
        $(#[$doc])*
        #[derive(Clone, Debug, PartialEq)]
        #[allow(missing_docs, reason = "rows and fields are the types and fields of their names")]
        pub enum $Node {
            $(
                $(#[$row_doc])*
                $Type $(($($Part),*))? $({ $($field: $Field),* })? $(($Value))?,
            )*
        }

        impl $Node {
            /// The names of all types that such a node can be.
            pub const NAMES: &[&str] = &[$(stringify!($Type)),*];

            /// The node's type, its fields and their names.
            pub fn literal(&self) -> Literal<'_> {
                match self {
                    $(Self::$Type $(($($part),*))? $({ $($field),* })? $(($value))? => Literal {
                        module: stringify!($module),
                        name: stringify!($Type),
                        form: form!($(($($part)*))? $({ $($field)* })? $(= $value)?),
                        fields: vec![
                            $($((stringify!($part), AsField::field($part)),)*)?
                            $($((stringify!($field), AsField::field($field)),)*)?
                            $((stringify!($value), AsField::field($value)),)?
                        ],
                    },)*
                }
            }

            /// The node as the interpreted renderer runs it.
            pub fn boxed<'a, D: Domain + 'a>(&self) -> Box<dyn $Trait<D> + Send + Sync + 'a> {
                match self {
                    $(Self::$Type $(($($part),*))? $({ $($field),* })? $(($value))? => {
                        Box::new(Entered(value!(
                            crate::$module::$Type
                            $(($(Boxing::<'a, D>::boxed($part)),*))?
                            $({ $($field: Boxing::<'a, D>::boxed($field)),* })?
                            $(= Boxing::<'a, D>::boxed($value))?
                        )))
                    })*
                }
            }
        }

        impl<'a, D: Domain + 'a> Boxing<'a, D> for $Node {
            type Boxed = Box<dyn $Trait<D> + Send + Sync + 'a>;

            fn boxed(&self) -> Self::Boxed {
                self.boxed()
            }
        }
    )*};
}

/// The form of a row.
macro_rules! form {
    () => {
        Form::Unit
    };
    (($($part:ident)*)) => {
        Form::Tuple
    };
    ({ $($field:ident)* }) => {
        Form::Struct
    };
    (= $value:ident) => {
        Form::Value
    };
}

/// The value of a row.
macro_rules! value {
    ($type:path = $value:expr) => {
        $value
    };
    ($($literal:tt)*) => {
        $($literal)*
    };
}

pub(super) use {form, nodes, value};
