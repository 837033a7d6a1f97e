//! Where lines of emitted Rust break: rustfmt's rules with its default widths, for the few forms that are emitted.

/// Longest line.
const WIDTH: usize = 100;
/// Longest arguments of a call on one line.
const ARGUMENTS: usize = 60;
/// Longest fields of a struct literal on one line.
const FIELDS: usize = 18;
/// Columns of a level.
const LEVEL: usize = 4;

/// A type or an expression, before it is broken into lines.
#[derive(Debug, Clone)]
pub(super) enum Code {
    /// Never broken.
    Word(String),
    /// A call, a tuple or a type with arguments: `open` ends with a bracket.
    List { open: String, items: Vec<Code> },
    /// A struct literal: what precedes each value, such as `albedo: `, and at the end the rest of the fields.
    Fields {
        name: String,
        fields: Vec<(String, Code)>,
        rest: Option<&'static str>,
    },
    /// A method call, with the dot.
    Method {
        receiver: Box<Code>,
        call: &'static str,
    },
}

impl Code {
    pub(super) fn word(text: impl Into<String>) -> Self {
        Self::Word(text.into())
    }

    /// A call or a tuple struct; a tuple without a name.
    pub(super) fn call(name: &str, items: impl Into<Vec<Self>>) -> Self {
        Self::list(format!("{name}("), items)
    }

    /// A type with arguments.
    pub(super) fn generic(name: &str, items: impl Into<Vec<Self>>) -> Self {
        Self::list(format!("{name}<"), items)
    }

    fn list(open: String, items: impl Into<Vec<Self>>) -> Self {
        let items = items.into();
        Self::List { open, items }
    }

    /// A struct literal.
    pub(super) fn literal(
        name: &str,
        fields: impl IntoIterator<Item = (&'static str, Self)>,
    ) -> Self {
        Self::Fields {
            name: name.to_owned(),
            fields: fields
                .into_iter()
                .map(|(name, value)| field(name, value))
                .collect(),
            rest: None,
        }
    }

    /// The struct literal with the other fields of a value.
    pub(super) fn with_rest(self, value: &'static str) -> Self {
        match self {
            Self::Fields { name, fields, .. } => {
                let rest = Some(value);
                Self::Fields { name, fields, rest }
            }
            other => other,
        }
    }

    /// A method called on it.
    pub(super) fn method(self, call: &'static str) -> Self {
        let receiver = Box::new(self);
        Self::Method { receiver, call }
    }

    /// In lines, where the first starts at a column of a line that is indented by `indent`, and the last is followed by
    /// `after` more columns.
    pub(super) fn lines(&self, indent: usize, column: usize, after: usize) -> String {
        match self.one_line() {
            Some(line) if column + line.len() + after <= WIDTH => line,
            _ => self.broken(indent, column, after),
        }
    }

    /// `let name = self;` in lines.
    pub(super) fn bind(&self, name: &str, indent: usize) -> String {
        let start = format!("let {name} =");
        let inner = indent + LEVEL;
        let column = indent + start.len() + 1;
        match self.one_line() {
            Some(line) if column + line.len() + 1 > WIDTH && inner + line.len() < WIDTH => {
                format!("{start}\n{}{line};", spaces(inner))
            }
            _ => format!("{start} {};", self.lines(indent, column, 1)),
        }
    }

    /// On one line, if that is allowed where there is room.
    fn one_line(&self) -> Option<String> {
        match self {
            Self::Word(text) => Some(text.clone()),
            Self::List { open, items } => {
                let items: Option<Vec<_>> = items.iter().map(Self::one_line).collect();
                let (items, close) = (items?.join(", "), closing(open));
                let narrow = close == '>' || self.single().is_some() || items.len() <= ARGUMENTS;
                narrow.then(|| format!("{open}{items}{close}"))
            }
            Self::Fields { name, fields, rest } => {
                let fields = fields
                    .iter()
                    .map(|(name, value)| Some(format!("{name}{}", value.one_line()?)));
                let mut fields = fields.collect::<Option<Vec<_>>>()?;
                fields.extend(rest.map(|rest| format!("..{rest}")));
                let fields = fields.join(", ");
                (fields.len() <= FIELDS).then(|| format!("{name} {{ {fields} }}"))
            }
            Self::Method { receiver, call } => Some(format!("{}{call}", receiver.one_line()?)),
        }
    }

    /// The only argument of a call.
    fn single(&self) -> Option<&Self> {
        match self {
            Self::List { open, items } if closing(open) == ')' && items.len() == 1 => items.first(),
            _ => None,
        }
    }

    fn broken(&self, indent: usize, column: usize, after: usize) -> String {
        let inner = indent + LEVEL;
        match self {
            Self::Word(text) => text.clone(),
            Self::List { open, items } => {
                // A call's only argument opens where the call does.
                if let Some(item @ (Self::List { .. } | Self::Fields { .. })) = self.single() {
                    let item = item.lines(indent, column + open.len(), after + 1);
                    return format!("{open}{item})");
                }
                let items = items.iter().map(|item| item.lines(inner, inner, 1));
                block(open, items, indent, &closing(open).to_string())
            }
            Self::Fields { name, fields, rest } => {
                let field = |(name, value): &(String, Self)| {
                    format!("{name}{}", value.lines(inner, inner + name.len(), 1))
                };
                let close = match rest {
                    None => "}".to_owned(),
                    Some(rest) => format!("{}..{rest}\n{}}}", spaces(LEVEL), spaces(indent)),
                };
                block(
                    &format!("{name} {{"),
                    fields.iter().map(field),
                    indent,
                    &close,
                )
            }
            Self::Method { receiver, call } => match receiver.one_line() {
                Some(line) if column + line.len() <= WIDTH => {
                    format!("{line}\n{}{call}", spaces(inner))
                }
                _ => {
                    let receiver = receiver.broken(indent, column, 0);
                    format!("{receiver}\n{}{call}", spaces(indent))
                }
            },
        }
    }
}

/// A field, short where the value has the field's name.
fn field(name: &'static str, value: Code) -> (String, Code) {
    match &value {
        Code::Word(text) if text == name => (String::new(), value),
        _ => (format!("{name}: "), value),
    }
}

fn closing(open: &str) -> char {
    if open.ends_with('<') { '>' } else { ')' }
}

/// Lines of their own between brackets, the last one indented as the first.
fn block(open: &str, lines: impl Iterator<Item = String>, indent: usize, close: &str) -> String {
    let (inner, outer) = (spaces(indent + LEVEL), spaces(indent));
    let lines: String = lines.map(|line| format!("{inner}{line},\n")).collect();
    format!("{open}\n{lines}{outer}{close}")
}

fn spaces(count: usize) -> String {
    " ".repeat(count)
}
