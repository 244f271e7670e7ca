//! Words for lexical and syntactic findings (codes 0001 to 0099).

use apt_syntax::error::SyntaxErrorKind as Kind;

use super::{Text, say};

pub(super) fn word(kind: &Kind) -> Text {
    lexical(kind).or_else(|| statement(kind)).or_else(|| expression(kind)).unwrap_or_else(|| list(kind))
}

fn lexical(kind: &Kind) -> Option<Text> {
    Some(match kind {
        Kind::NameTooLong { name, limit, pieces } => {
            let hint = if pieces.len() > 1 {
                format!(
                    "blanks do not separate words; if {} were meant, put a comma between them",
                    pieces.join(" and ")
                )
            } else {
                format!("use at most {limit} characters, or the dialect `free`, which takes longer names")
            };
            say("APT0001", format!("the name {name} is longer than {limit} characters")).hint(hint)
        }
        Kind::NumberTooLong { digits, limit } => {
            say("APT0002", format!("the number has {digits} significant digits; this dialect takes {limit}"))
                .hint("a comma may be missing between two numbers, for blanks do not separate them")
        }
        Kind::NumberNotConvertible { text } => {
            say("APT0003", format!("{text} is not a number that can be represented"))
        }
        Kind::MisplacedDecimalPoint => {
            say("APT0004", "a decimal point cannot stand here").hint("a comma may be missing before it")
        }
        Kind::IllegalCharacter(character) => {
            let said = say("APT0005", format!("the character {character:?} is not part of the language"));
            match character {
                ';' => said.hint(
                    "in the dialect free it separates statements: set `dialect = \"free\"` in apt-lsp.toml, or \
                     write one statement on a line",
                ),
                _ => said,
            }
        }
        Kind::UnclosedText => say("APT0006", "the quoted text is not closed"),
        Kind::TextWordNotInColumnOne { word } => say(
            "APT0007",
            format!("{word} is recognised in columns 1 to 6 only"),
        )
        .hint(
            "move it to the start of the line; with `dialect = \"free\"` in apt-lsp.toml it may be indented",
        ),
        Kind::RunsIntoSequenceField => say("APT0008", "the statement runs past column 72 and is cut there")
            .hint("end the line with $ before column 72 and go on with the next line"),
        _ => return None,
    })
}

fn statement(kind: &Kind) -> Option<Text> {
    Some(match kind {
        Kind::BadStatementStart => say("APT0010", "a statement begins with a name or a word of the language")
            .hint("perhaps the line before should end with $ to be continued; in a macro, a variable that stands for a number cannot be given another value"),
        Kind::TooManyElements { count, limit } => {
            say("APT0011", format!("the statement has {count} elements; this dialect takes {limit}"))
                .hint("split the statement")
        }
        Kind::LabelWithoutStatement => say("APT0012", "the label is not followed by a statement"),
        Kind::WordAsLabel(word) => {
            say("APT0013", format!("{word} is a word of the language and cannot be a label"))
        }
        Kind::EndsOnPunctuation => say("APT0014", "the statement ends on punctuation")
            .hint("complete it, or end the line with $ to continue it on the next one"),
        Kind::UnclosedParenthesis => say("APT0015", "this parenthesis is never closed"),
        Kind::UnopenedParenthesis => say("APT0016", "this parenthesis was never opened"),
        Kind::NameWithoutEquals { name, .. } => {
            say("APT0017", format!("{name} is neither a word of the language nor followed by =")).hint(
                "a statement is `name = value`, or begins with a word of the language; check the spelling",
            )
        }
        Kind::StructuredIf { word } => {
            say("APT0065", format!("{word} belongs to an IF over several statements, which this dialect does not have"))
                .hint(
                    "the dialect free has it: set `dialect = \"free\"` in apt-lsp.toml, or begin the file with \
                     `$$ apt-lsp: dialect=free`; IF(a-b) takes three labels in every dialect",
                )
        }
        Kind::NotInDialect { word, dialect } => {
            say("APT0905", format!("{word} is not part of this dialect")).hint(format!(
                "the dialect {dialect} has it: set `dialect = \"{dialect}\"` in apt-lsp.toml, or begin the file \
                 with `$$ apt-lsp: dialect={dialect}`"
            ))
        }
        Kind::WordNotAllowed(word) => say("APT0018", format!("the word {word} cannot stand here")),
        Kind::NoSlash(word) => {
            say("APT0019", format!("{word} is a word of the language and cannot be used as a name"))
                .hint("choose another name, or write the parameters after a slash")
        }
        Kind::SlashMissing { statement, word } => {
            let form = match statement.as_str() {
                "OBTAIN" => "OBTAIN,CIRCLE/C1,X,Y",
                "DO" => "DO/label,index=first,last,step",
                "TRANTO" => "TRANTO/label",
                _ => "JUMPTO/label",
            };
            say("APT0072", format!("a slash is missing behind {word}")).hint(format!("the form is {form}"))
        }
        Kind::ToolPositionTwice { first, second } => {
            say("APT0071", format!("{second} says where the tool is, which {first} has said before"))
                .hint(format!("write one of the two; the last one, {second}, is taken"))
        }
        Kind::WordRequired => {
            say("APT0020", "after this comma a statement must begin, with a word of the language")
        }
        Kind::FiniNotAlone => say("APT0021", "FINI stands alone on its statement"),
        Kind::TakesNoParameters(word) => say("APT0022", format!("{word} takes no parameters"))
            .hint(format!("write {word} alone; another statement may follow after a comma")),
        _ => return None,
    })
}

fn expression(kind: &Kind) -> Option<Text> {
    Some(match kind {
        Kind::TwoOperators => say("APT0030", "two operators stand in a row"),
        Kind::OperandMissing => say("APT0031", "a value is missing here"),
        Kind::EmptyParentheses => say("APT0032", "there is nothing between the parentheses"),
        Kind::FunctionWithoutParentheses(function) => {
            say("APT0033", format!("{function} needs its argument in parentheses"))
                .hint(format!("write {function}(…)"))
        }
        Kind::TooManyPowers => say("APT0034", "too many ** follow each other"),
        Kind::TooDeep => say("APT0035", "parentheses are nested too deep")
            .hint("compute parts of it in statements of their own"),
        Kind::RelationNotAllowed(relation) if matches!(&**relation, ".NOT." | ".EOR." | ".XOR.") => {
            say("APT0036", format!("{relation} cannot stand here"))
                .hint("turn the relation round (.NE. for .NOT. .EQ.), or write the condition with .AND. and .OR.")
        }
        Kind::RelationNotAllowed(relation) => {
            say("APT0036", format!("{relation} belongs to a logical IF, which this dialect does not have here"))
                .hint(
                    "the dialects apt4 and free have IF(a.EQ.b)statement: set `dialect = \"apt4\"` in apt-lsp.toml, or begin the \
                     file with `$$ apt-lsp: dialect=apt4`; IF(expression) negative,zero,positive works everywhere",
                )
        }
        Kind::RelationMissing => say("APT0037", "a relation such as .LT. is missing in the condition"),
        _ => return None,
    })
}

fn list(kind: &Kind) -> Text {
    match kind {
        Kind::MissingSeparator => say("APT0040", "a comma or an operator is missing here"),
        Kind::ListWithoutWord { name, .. } => {
            say("APT0040", format!("{name} is no word that takes a list; {name}/ only divides"))
                .hint("a definition is name=WORD/parameters; check the spelling of the word")
        }
        Kind::OperatorInList => say("APT0041", "an expression in a list must stand in parentheses")
            .hint("write (a+b) instead of a+b"),
        Kind::EmptyPosition => say("APT0042", "there is nothing between these commas"),
        Kind::UnexpectedMark(mark) => say("APT0043", format!("{mark} cannot stand here")),
        Kind::MissingParameters => say("APT0044", "parameters are missing after the slash"),
        Kind::UnknownFunction(name) => say("APT0046", format!("there is no function {name}")).hint(
            "an array takes one subscript; later functions such as MAXF exist in the dialects free and apt4",
        ),
        Kind::BadInclusiveSubscript => say("APT0045", "the inclusive subscript is badly formed")
            .hint("its forms are (a,THRU,b), (ALL), (a,THRU,ALL), with INCR or DECR and a step at the end"),
        Kind::MacroForm => say("APT0050", "a macro begins with name=MACRO/variables"),
        Kind::MacroVariableNotName => say("APT0051", "a macro variable must be a name"),
        Kind::MacroValueExpression => {
            say("APT0052", "a macro value must be a number, a name or a word, not an expression")
                .hint("compute it into a scalar before, and pass the scalar")
        }
        Kind::MacroValueNested => say(
            "APT0053",
            "a macro value must be a number, a name or a word, not a nest or a subscripted name",
        )
        .hint("give it a name before, and pass the name"),
        Kind::MacroValueMissing => say("APT0054", "the value of the macro variable is missing after ="),
        Kind::CallWithoutSlash => say("APT0055", "CALL is followed by a slash and the name of a macro"),
        Kind::CallNameExpected => say("APT0056", "after CALL/ comes the name of a macro"),
        Kind::CallValueExpected { name } => {
            say("APT0057", format!("the variable {name} needs = and a value"))
        }
        Kind::CallCommaExpected => say("APT0058", "the values of a CALL are separated by commas"),
        Kind::LabelMissing => say("APT0059", "a label is missing here"),
        Kind::LabelCount { found, expected } => {
            say("APT0060", format!("there are {found} labels where {expected} are needed"))
        }
        Kind::ConditionMissing => say("APT0061", "IF is followed by its condition in parentheses"),
        Kind::LogicalIfStatement => say("APT0062", "a logical IF is followed by one statement"),
        Kind::ConditionalDo => say("APT0066", "DO cannot be the statement of an IF")
            .hint("the loop reaches over several statements: jump over it with IF and JUMPTO"),
        Kind::TooManyNests { count, limit } => say(
            "APT0070",
            format!("the statement has {count} nested definitions, and APT III takes {limit}"),
        )
        .hint("define some of them before, in statements of their own; the dialect free takes any number"),
        Kind::ConditionalClause { word } => {
            say("APT0067", format!("{word} cannot be the statement of an IF"))
                .hint("a clause of an IF over several statements stands alone on its line")
        }
        Kind::RunsOnAfterWord { word } => {
            say("APT0068", format!("{word} stands alone at the end of its statement"))
                .hint("blanks mean nothing here: begin a new line, or put ; between the statements")
        }
        Kind::ThenMissing { word } => {
            say("APT0069", format!("THEN is missing behind the condition of {word}"))
                .hint("IF takes THEN or a statement, ELSEIF takes THEN")
        }
        Kind::ObtainTypeExpected => say("APT0063", "OBTAIN is followed by the type of the surface")
            .hint("the form is OBTAIN,CIRCLE/C1,X,Y"),
        Kind::ObtainComma(word) => {
            say("APT0063", format!("a slash stands between {word} and the surface of OBTAIN"))
                .hint(format!("the form is OBTAIN,{word}/name,first,second"))
        }
        Kind::DoForm => say("APT0064", "the form is DO/label,index=first,last,step"),
        // The other groups have taken the rest.
        other => say("APT0099", format!("{other}")),
    }
}
