//! Mistakes and the APT III numbers that they get (language reference 9.2 and 9.5).

mod support;

use apt_syntax::DialectName::{self, Apt3, Apt4, Free};
use apt_syntax::statement::Body;
use support::parse;

fn check(dialect: DialectName, cases: &[(&str, &[u16])]) {
    let wrong: Vec<String> = cases
        .iter()
        .filter_map(|(text, expected)| {
            let parsed = parse(text, dialect);
            let numbers: Vec<u16> = parsed.errors.iter().filter_map(|error| error.apt3()).collect();
            // The header of a macro stays one whatever is wrong in it; its name is spoiled.
            let spoiled = |body: &Body| parsed.spoiled.is_some() && matches!(body, Body::Macro { .. });
            let says_nothing = |body: &Body| *body == Body::Error || spoiled(body);
            let broken = parsed.statement.parts.iter().any(|part| says_nothing(&part.body));
            let fine = numbers == *expected && parsed.is_broken() == broken;
            (!fine).then(|| format!("{text:?}: expected {expected:?}, found {:?}", parsed.errors))
        })
        .collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn numbers_of_apt_iii() {
    check(
        Free,
        &[
            ("LONG NAME=3", &[1]),
            ("LONGNAME=3", &[]),
            ("A=12345678901234567890", &[2]),
            ("A=-1.7999999999999998", &[]),
            ("A=-1.79999999999999981", &[2]),
            ("A=1.E999", &[4]),
            ("=3", &[5]),
            ("5=3", &[5]),
            (",A=3", &[5]),
            ("A=3(4)", &[7]),
            ("SPINDL/3+4", &[7]),
            ("P=POINT 1,2", &[7]),
            ("P=POINT/1,,2", &[7]),
            ("A=(2+3)(4+5)", &[7]),
            ("A?B=3", &[8]),
            ("A=3+4)", &[9]),
            ("A=(3+4", &[10]),
            ("L1=LINE/(POINT/0,0,(POINT/1,1)", &[10]),
            ("A=3*", &[11]),
            ("COPY/", &[11]),
            ("XX)", &[11]),
            ("XX) $$ text", &[11]),
            ("GOTO/P1,", &[11]),
            ("A=3,", &[11]),
            ("A=SINF(3),", &[11]),
            ("SPINDL/3+", &[11]),
            ("POINT) A=1", &[17]),
            ("A=B.5", &[20]),
            ("ELSE=3", &[]),
            ("FINI,", &[23]),
            ("FINI/1", &[23]),
            ("A=3+*4", &[54]),
            ("A=*3", &[54]),
            ("A=--5", &[54]),
            ("A=SINF+1", &[59]),
            ("POINT/1,2", &[76]),
            ("TANTO/L1", &[76]),
            ("ZIGZAG", &[76]),
            ("SEC1", &[76]),
            ("A=TO+1", &[76]),
            ("A=()", &[78]),
            ("A=SINF()", &[78]),
            ("IF=3", &[78]),
            ("RAPID,P1", &[81]),
            ("NOSUCH/3", &[82]),
            ("A1", &[82]),
            ("A(1)", &[82]),
            ("A=MAXF(1,2)", &[]),
            ("A=NOSUCH(1,2)", &[108]),
            ("SCON/INIT,ALL", &[82]),
            ("PRINT/3,A(1,THRU)", &[109]),
            ("P=POINT/", &[129]),
            ("OBTAIN,L1,A", &[153]),
            ("OBTAIN,TANTO/L1,A", &[153]),
            ("OBTAIN,POINT,P1,X,Y", &[155]),
            ("OBTAIN,POINT=P1,X,Y", &[155]),
            ("POINT=3", &[155]),
            ("LINE=POINT/1,2,3", &[155]),
            ("A=POINT+1", &[155]),
            ("M/MACRO", &[203]),
            ("M=MACRO/POINT", &[207]),
            ("M=MACRO/5", &[207]),
            ("CALL/POINT", &[226]),
            ("CALL", &[227]),
            ("CALL/M,A", &[229]),
            ("CALL/M,A=(POINT/1,2)", &[232]),
            ("CALL/M,A=B(2)", &[234]),
            ("CALL/M A=3", &[234]),
            ("CALL/M,A=3+4", &[235]),
            ("JUMPTO/(A)", &[403]),
            ("IF(A)B,C", &[409]),
            ("IF(A)B,C,D,E", &[409]),
            ("STOP/3", &[505]),
            ("RAPID/ON", &[505]),
            ("A=INTF(3)", &[]),
        ],
    );
}

#[test]
fn other_dialects() {
    check(Apt4, &[("Z=3$\nPOINT/1,2", &[7]), ("W=3)", &[9]), ("R=ABSF(-3", &[10]), ("IF(A.EQ.1)", &[11])]);
    check(Apt4, &[("LONGNAME=3", &[1]), ("IF(.NOT.A.EQ.1)B=2", &[20])]);
    check(Apt3, &[("IF(A.EQ.1)B=2", &[20]), ("A;B=3", &[8]), ("  PPRINT X", &[21]), ("ENDIF", &[82])]);
    check(Apt3, &[("DO/A,I=1,3", &[82]), ("ELSE", &[82]), ("ELSEIF(A-1)", &[82]), ("IF(A.EQ.1)THEN", &[82])]);
    check(Apt3, &[("LONGNAME=3", &[1]), ("A=MAXF(1,2)", &[108])]);
    check(Apt4, &[("A;B=3", &[8])]);
    let many = format!("GOTO/{}1", "1,".repeat(300));
    check(Apt3, &[(&many.replace("1,", "1,$\n"), &[13])]);
    check(Free, &[(&many, &[])]);
    let nests = |count: usize| format!("P=PATERN/RANDOM{}", ",$\n(POINT/1,2),$\n(3,4)".repeat(count));
    for (count, dialect, expected) in
        [(5, Apt3, &[][..]), (6, Apt3, &[70][..]), (6, Free, &[]), (6, Apt4, &[])]
    {
        check(dialect, &[(&nests(count), expected)]);
    }
}

#[test]
fn long_names_are_told_and_cut() {
    for dialect in [Apt3, Apt4] {
        let parsed = parse("LONGNAMES=LONGNAM+1", dialect);
        assert!(!parsed.is_broken());
        assert_eq!(
            (parsed.elements[0].text.as_str(), parsed.elements[2].text.as_str()),
            ("LONGNA", "LONGNA"),
            "{dialect:?}"
        );
        assert_eq!(parsed.errors.len(), 2);
    }
}

#[test]
fn a_missing_comma_can_be_seen() {
    let parsed = parse("P=POINT/1 2", Free);
    assert_eq!(parsed.errors, []);
    assert_eq!(parsed.joined.len(), 1);
    assert_eq!(parsed.joined[0].pieces, ["1", "2"]);
    assert!(parse("P=POINT/1$\n2", Free).joined.is_empty(), "a number divided over two records is meant");
}

#[test]
fn the_name_of_a_broken_definition_is_kept() {
    let spoiled = |text| parse(text, Free).spoiled.map(|name| name.text.to_string());
    assert_eq!(spoiled("P=POINT/1,,2"), Some("P".to_owned()));
    assert_eq!(spoiled("P=POINT/(1,2"), Some("P".to_owned()));
    assert_eq!(spoiled("P=POINT/1,2"), None);
    assert_eq!(spoiled("GOTO/P,"), None);
}

#[test]
fn text_that_cards_cut_is_warned_of() {
    let text = format!("{:<70}(4+5)", "A=3");
    let parsed = parse(&text, Apt3);
    assert!(parsed.errors.iter().any(|error| error.kind.is_warning()), "{:?}", parsed.errors);
    assert!(parse(&text, Free).errors.is_empty() || parse(&text, Free).is_broken());
}

#[test]
fn a_statement_says_once_where_the_tool_is() {
    let twice = [
        "TLLFT,TLRGT",
        "TLON,TLNDON,GOLFT/L1,TO,L2",
        "TLLFT,TLONPS,TLLFT,GOLFT/L1,TO,L2",
        "TLONPS,TLOFPS",
        "IF(A.LT.B)TLLFT,TLRGT,GOFWD/L1,TO,L2",
    ];
    for text in twice {
        let parsed = parse(text, Free);
        assert_eq!(parsed.errors.len(), 1, "{text}: {:?}", parsed.errors);
        assert!(!parsed.is_broken(), "{text}: the motion is still to be made");
        let first_words: Vec<&str> = ["TLRGT", "TLNDON", "TLOFPS", "TLLFT"].into();
        let range = parsed.errors[0].range;
        let word = &text[usize::from(range.start())..usize::from(range.end())];
        assert!(first_words.contains(&word), "{text}: {word}");
    }
    for text in ["TLLFT", "TLLFT,TLONPS,GOLFT/L1,TO,L2", "TLOFPS,TLRGT,GOLFT/L1,TO,L2", "TLON,TLONPS"] {
        assert_eq!(parse(text, Free).errors, vec![], "{text}");
    }
}
