//! Where lines of emitted Rust break: rustfmt's rules with its default widths, for the few forms that are emitted.

/// Longest line.
pub(super) const WIDTH: usize = 100;
/// Longest arguments of a call on one line.
const ARGUMENTS: usize = 60;
/// Longest fields of a struct literal on one line.
const FIELDS: usize = 18;
/// Columns of a level.
pub(super) const LEVEL: usize = 4;

/// Text that starts with a name, and where the name is from.
#[derive(Debug, Clone)]
pub(super) struct Name {
    pub(super) text: String,
    pub(super) origin: Origin,
}

/// Where a name is from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Origin {
    /// It is known everywhere: a number, a keyword, a primitive type, a local variable.
    Known,
    /// The emitted module, of which programs are modules.
    Emitted,
    /// A module of the renderer's crate.
    Render(&'static str),
}

impl Name {
    /// What is known everywhere.
    pub(super) fn known(text: impl Into<String>) -> Self {
        let (text, origin) = (text.into(), Origin::Known);
        Self { text, origin }
    }

    /// Something of the emitted module.
    pub(super) fn emitted(text: impl Into<String>) -> Self {
        let (text, origin) = (text.into(), Origin::Emitted);
        Self { text, origin }
    }

    /// Something of a module of the renderer's crate.
    pub(super) fn of(module: &'static str, text: impl Into<String>) -> Self {
        let (text, origin) = (text.into(), Origin::Render(module));
        Self { text, origin }
    }
}

/// A type or an expression, before it is broken into lines.
#[derive(Debug, Clone)]
pub(super) enum Code {
    /// Never broken.
    Word(Name),
    /// A call, a tuple or a type with arguments: its name with the bracket that opens.
    List { open: Name, items: Vec<Code> },
    /// A struct literal: what precedes each value, such as `albedo: `, and at the end the rest of the fields.
    Fields {
        name: Name,
        fields: Vec<(String, Code)>,
        rest: Option<&'static str>,
    },
    /// A method call, with the dot, and the trait that has the method.
    Method {
        receiver: Box<Code>,
        call: &'static str,
        of: Name,
    },
}

impl Code {
    /// A word that is known everywhere.
    pub(super) fn word(text: impl Into<String>) -> Self {
        Self::Word(Name::known(text))
    }

    /// A tuple.
    pub(super) fn tuple(items: impl Into<Vec<Self>>) -> Self {
        Self::call(Name::known(""), items)
    }

    /// A call or a tuple struct.
    pub(super) fn call(name: Name, items: impl Into<Vec<Self>>) -> Self {
        Self::list(name, '(', items)
    }

    /// A type with arguments.
    pub(super) fn generic(name: Name, items: impl Into<Vec<Self>>) -> Self {
        Self::list(name, '<', items)
    }

    fn list(mut open: Name, bracket: char, items: impl Into<Vec<Self>>) -> Self {
        open.text.push(bracket);
        let items = items.into();
        Self::List { open, items }
    }

    /// A struct literal.
    pub(super) fn literal(
        name: Name,
        fields: impl IntoIterator<Item = (&'static str, Self)>,
    ) -> Self {
        Self::Fields {
            name,
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

    /// A method of a trait called on it.
    pub(super) fn method(self, call: &'static str, of: Name) -> Self {
        let receiver = Box::new(self);
        Self::Method { receiver, call, of }
    }

    /// All names in it.
    pub(super) fn names(&self) -> Vec<&Name> {
        let (name, parts): (_, Vec<&Self>) = match self {
            Self::Word(name) => (name, Vec::new()),
            Self::List { open, items } => (open, items.iter().collect()),
            Self::Fields { name, fields, .. } => {
                (name, fields.iter().map(|(_, value)| value).collect())
            }
            Self::Method { receiver, of, .. } => (of, vec![&**receiver]),
        };
        let inner = parts.into_iter().flat_map(Self::names);
        std::iter::once(name).chain(inner).collect()
    }

    /// In lines, where the first starts at a column of a line that is indented by `indent`, and the last is followed by
    /// `after` more columns.
    pub(super) fn lines(&self, indent: usize, column: usize, after: usize) -> String {
        match self.one_line() {
            Some(line) if column + line.len() + after <= WIDTH => line,
            _ => self.broken(indent, column, after),
        }
    }

    /// `what = self;` in lines.
    pub(super) fn defines(&self, what: &str, indent: usize) -> String {
        let start = format!("{what} =");
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
            Self::Word(name) => Some(name.text.clone()),
            Self::List { open, items } => {
                let items: Option<Vec<_>> = items.iter().map(Self::one_line).collect();
                let open = &open.text;
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
                (fields.len() <= FIELDS).then(|| format!("{} {{ {fields} }}", name.text))
            }
            Self::Method { receiver, call, .. } => Some(format!("{}{call}", receiver.one_line()?)),
        }
    }

    /// The only argument of a call.
    fn single(&self) -> Option<&Self> {
        match self {
            Self::List { open, items } if closing(&open.text) == ')' && items.len() == 1 => {
                items.first()
            }
            _ => None,
        }
    }

    fn broken(&self, indent: usize, column: usize, after: usize) -> String {
        let inner = indent + LEVEL;
        match self {
            Self::Word(name) => name.text.clone(),
            Self::List { open, items } => {
                let open = &open.text;
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
                    &format!("{} {{", name.text),
                    fields.iter().map(field),
                    indent,
                    &close,
                )
            }
            Self::Method { receiver, call, .. } => match receiver.one_line() {
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
        Code::Word(word) if word.text == name => (String::new(), value),
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
