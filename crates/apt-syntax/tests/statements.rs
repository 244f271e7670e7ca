//! What statements say: every form of the grammar.

mod support;

use apt_syntax::DialectName::{self, Apt3, Apt4, Cl, Free};
use support::short;

fn check(dialect: DialectName, cases: &[(&str, &str)]) {
    let wrong: Vec<String> = cases
        .iter()
        .filter_map(|(text, expected)| {
            let found = short(text, dialect);
            (found != *expected).then(|| format!("{text:?}\n  expected {expected}\n  found    {found}"))
        })
        .collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn blanks_mean_nothing_and_records_join() {
    check(
        Free,
        &[
            ("A C=7", "(let AC 7)"),
            ("W=2 3", "(let W 23)"),
            ("AB$\nCD=12$\n34", "(let ABCD 1234)"),
            ("sp indl / 5 00 , cc lw", "(SPINDL/ 500 'CCLW)"),
            ("\tX=1\t", "(let X 1)"),
            ("X=2 $$ a $$ b", "(let X 2)"),
            ("X=2$ text\n$ more text\n+3", "(let X (+ 2 3))"),
        ],
    );
    check(Free, &[("$$ only a comment\n", ""), ("   \n", "")]);
}

#[test]
fn numbers_and_names() {
    check(
        Free,
        &[
            ("X=1.", "(let X 1)"),
            ("X=.01E2", "(let X 1)"),
            ("X=1.E+2", "(let X 100)"),
            ("X=.5E-1", "(let X 0.05)"),
            ("X=.E2", "(let X 0)"),
            ("X=10E2", "(let X 10E2)"),
            ("12A=1B", "(let 12A 1B)"),
            ("2A=1", "(let 2A 1)"),
            ("C=LCONIC/3PT2SL,P1,1,P2,2,P3", "(define C LCONIC '3PT2SL P1 1 P2 2 P3)"),
            ("2DCALC", "(2DCALC)"),
            ("X=1.2.3", "(error) !MisplacedDecimalPoint"),
            ("X=A.5", "(error) !MisplacedDecimalPoint"),
            ("X=12345678901234567", "(let X 12345678901234568)"),
            ("X=123456789012345678", "(let X 123456789012345680) !NumberTooLong { digits: 18, limit: 17 }"),
            ("X=000000000000000001", "(let X 1)"),
            ("LONGNAME=3", "(let LONGNAME 3)"),
            (
                "LONG NAME=3",
                "(let LONGNAME 3) !NameTooLong { name: \"LONGNAME\", limit: 6, pieces: [\"LONG\", \"NAME\"] }",
            ),
        ],
    );
    check(Cl, &[("GOTO/3.3137084989847612345,0,0", "(GOTO/ 3.313708498984761 0 0)")]);
}

#[test]
fn arithmetic_of_apt_iii() {
    check(
        Free,
        &[
            ("A=-2**2", "(let A (** (neg 2) 2))"),
            ("A=3-B**2", "(let A (- 3 (** B 2)))"),
            ("A=2*-3", "(let A (* 2 (neg 3)))"),
            ("A=2**-1", "(let A (** 2 (neg 1)))"),
            ("A=2**3**2", "(let A (** 2 (** 3 2)))"),
            ("A=8/2/2", "(let A (/ (/ 8 2) 2))"),
            ("A=B**2/4*3", "(let A (* (/ (** B 2) 4) 3))"),
            ("A=(1+2)*3", "(let A (* (+ 1 2) 3))"),
            ("A=SINF(B+2)*DOTF(V1,(VECTOR/1,2,3))", "(let A (* (SINF (+ B 2)) (DOTF V1 [VECTOR 1 2 3])))"),
            ("A(I+1)=B(C(2))", "(let A<(+ I 1)> B<C<2>>)"),
            ("B=(D=3)+2", "(let B (+ (set D 3) 2))"),
            ("A=DISTF((LINE/XAXIS),L2)", "(let A (DISTF [LINE 'XAXIS] L2))"),
        ],
    );
}

#[test]
fn arithmetic_of_apt4() {
    check(
        Apt4,
        &[
            ("A=-3**2", "(let A (neg (** 3 2)))"),
            ("A=2**3**2", "(let A (** (** 2 3) 2))"),
            ("A=2**-2**2", "(let A (** (** 2 (neg 2)) 2))"),
            ("A=--5", "(let A (neg (neg 5)))"),
            ("A=1/-2", "(let A (/ 1 (neg 2)))"),
            ("X=Y=Z=4", "(let X (set Y (set Z 4)))"),
            ("R=(W=3)+1", "(let R (+ (set W 3) 1))"),
            ("B=A(I=I+1)", "(let B A<(set I (+ I 1))>)"),
            ("P=POINT/A+1,A*3,-A", "(define P POINT (+ A 1) (* A 3) (neg A))"),
            ("P=POINT/(X=5),(Y=X+1),Y", "(define P POINT (set X 5) (set Y (+ X 1)) Y)"),
            ("V=VECTOR/(A+1)*B,B/A,A**2", "(define V VECTOR (* (+ A 1) B) (/ B A) (** A 2))"),
            ("P=(1,2)", "(define P POINT 1 2)"),
            ("L=LINE/(0,0),(3,4)", "(define L LINE [0 0] [3 4])"),
            ("TO=4", "(let TO 4)"),
            ("X=TO+STOP*SIN-POINT", "(let X (- (+ TO (* STOP SIN)) POINT))"),
            ("A=MODF(7.5,2)", "(let A (MODF 7.5 2))"),
        ],
    );
}

#[test]
fn definitions_and_nests() {
    check(
        Free,
        &[
            ("P1=POINT/1,-2,+A", "(define P1 POINT 1 (neg 2) (pos A))"),
            ("L1=LINE/(POINT/1,2),(P2=POINT/3,4)", "(define L1 LINE [POINT 1 2] [P2=POINT 3 4])"),
            ("L1=LINE/(P(2)=POINT/3,4),P(I)", "(define L1 LINE [P<2>=POINT 3 4] P<I>)"),
            ("C=CIRCLE/(1,2),(3,-4),(5,(6+1),7)", "(define C CIRCLE [1 2] [3 (neg 4)] [5 (+ 6 1) 7])"),
            ("L=LINE/P,ATANGL,(A=45)", "(define L LINE P 'ATANGL (set A 45))"),
            ("C=CIRCLE/C1,CANON,,,,,,,.25", "(define C CIRCLE C1 'CANON _ _ _ _ _ _ 0.25)"),
            ("L=LINE/P1,(CENTER)", "(error) !WordNotAllowed(\"CENTER\")"),
            ("PA=PATERN/RANDOM,A(2,THRU,ALL,INCR,2)", "(define PA PATERN 'RANDOM A<2..ALL +2>)"),
            (
                "PA=PATERN/RANDOM,A(THRU,N),B(ALL,DECR,2),C(ALL)",
                "(define PA PATERN 'RANDOM A<1..N> B<1..ALL -2> C<1..ALL>)",
            ),
            (
                "GOLFT/(LINE/XAXIS),ON,2,INTOF,(C=CIRCLE/1,2,3)",
                "(GOLFT/ [LINE 'XAXIS] 'ON 2 'INTOF [C=CIRCLE 1 2 3])",
            ),
            ("M(3)=MATRIX/XYROT,90,TRANSL,1,2,3", "(define M<3> MATRIX 'XYROT 90 'TRANSL 1 2 3)"),
            ("OBTAIN,LINE/L1,A,,B", "(obtain LINE L1 A _ B)"),
            ("OBTAIN/POINT/P,X,Y(2)", "(obtain POINT P X Y<2>)"),
            ("INDIRV/,,V1", "(INDIRV/ _ _ V1)"),
        ],
    );
}

#[test]
fn major_words_and_several_statements() {
    check(
        Free,
        &[
            ("01) GOTO/P1", "01) (GOTO/ P1)"),
            ("A1)LOOPND", "A1) (LOOPND)"),
            ("RAPID,GOTO/P1", "(RAPID) ; (GOTO/ P1)"),
            ("NOPOST,CUTTER/.5", "(NOPOST) ; (CUTTER/ 0.5)"),
            ("TLLFT,TLOFPS,GORGT/L1,TO,L2", "(TLLFT) ; (TLOFPS) ; (GORGT/ L1 'TO L2)"),
            ("STOP,GOTO/1,1", "(STOP) ; (GOTO/ 1 1)"),
            ("TLLFT", "(TLLFT)"),
            ("FEDRAT", "(FEDRAT)"),
            ("SPINDL/(3+4),CLW", "(SPINDL/ (+ 3 4) 'CLW)"),
            ("MACHIN/LINUXCNC,2", "(MACHIN/ LINUXCNC 2)"),
            ("GO/TO,L1,PAST,(PLANE/0,0,1,0),ON,C1,5", "(GO/ 'TO L1 'PAST [PLANE 0 0 1 0] 'ON C1 5)"),
            ("GOFWD/L1,TO,L2,10,TO,L3,LAB", "(GOFWD/ L1 'TO L2 10 'TO L3 LAB)"),
            ("RESERV/A,50,B,10", "(RESERV/ A 50 B 10)"),
            ("SYN/PT,POINT", "(SYN/ PT 'POINT)"),
            ("UNITS/MM", "(UNITS/ 'MM)"),
            ("FEDRAT/300,MMPM", "(FEDRAT/ 300 'MMPM)"),
            ("FEDRAT/FEED,ANGLE", "(FEDRAT/ FEED ANGLE)"),
            ("CYCLE/DRILL,DEPTH", "(CYCLE/ 'DRILL DEPTH)"),
            ("FINI", "(FINI)"),
        ],
    );
}

#[test]
fn logic() {
    check(
        Free,
        &[
            ("IF(I-5) A1,2,03", "(if (- I 5) A1 2 03)"),
            ("JUMPTO/10", "(JUMPTO 10)"),
            ("TRANTO/LAB", "(TRANTO LAB)"),
            ("LOOPST", "(LOOPST)"),
            ("M=MACRO", "(macro M)"),
            ("M=MACRO/", "(macro M)"),
            ("M=MACRO/A,B=-5,T=POINT", "(macro M A B=-5 T=POINT)"),
            ("CALL/M", "(call M)"),
            ("CALL/M,A=Z,B=-1.5", "(call M A=Z B=-1.5)"),
            ("CALL/PROG,SEC1,1,X", "(call PROG SEC1 =1 =X)"),
            ("READ/2,SEG", "(READ/ 2 SEG)"),
        ],
    );
    check(
        Apt4,
        &[
            ("IF(X.EQ.1.AND.Y.EQ.2)Z1=1", "(when (and (Eq X 1) (Eq Y 2)) (let Z1 1))"),
            ("IF((X.EQ.2).OR.(Y+1.GE.3))GOTO/P", "(when (or (Eq X 2) (Ge (+ Y 1) 3)) (GOTO/ P))"),
            (
                "IF(A.LT.1.OR.B.GT.2.AND.C.NE.3)JUMPTO/5",
                "(when (or (Lt A 1) (and (Gt B 2) (Ne C 3))) (JUMPTO 5))",
            ),
            ("IF(A.LT.B)TLRGT,GORGT/L1,PAST,L2", "(when (Lt A B) (TLRGT) ; (GORGT/ L1 'PAST L2))"),
            ("IF(A.LT.B)TLRGT,A=1", "(error) !LogicalIfStatement"),
            ("IF(A.LT.B)A=1,TLRGT", "(error) !LogicalIfStatement"),
            ("IF(A-1)1,2,3", "(if (- A 1) 1 2 3)"),
            ("20)DO/A,I=1,N+1,-2", "20) (do A I 1 (+ N 1) (neg 2))"),
            ("CALL/M3,S=Y,P=(POINT/3,4),A=3+4,B=C(2)", "(call M3 S=Y P=(POINT/3,4) A=3+4 B=C(2))"),
        ],
    );
}

#[test]
fn ifs_over_several_statements() {
    check(
        Free,
        &[
            ("IF(X.EQ.1)THEN", "(IF (Eq X 1))"),
            ("A)if ( x .gt. y+1 ) then", "A) (IF (Gt X (+ Y 1)))"),
            (
                "IF(A.LT.1.AND..NOT.(B.GT.2.OR.C.NE.3))THEN",
                "(IF (and (Lt A 1) (not (or (Gt B 2) (Ne C 3)))))",
            ),
            ("IF(.NOT..NOT.A.LT.1)B=2", "(when (not (not (Lt A 1))) (let B 2))"),
            ("ELSEIF(X.EQ.2)THEN", "(ELSEIF (Eq X 2))"),
            ("ELSE IF (X.EQ.2) THEN", "(ELSEIF (Eq X 2))"),
            ("ELSE", "(ELSE)"),
            ("B)END IF", "B) (ENDIF)"),
            ("IF(X.EQ.1)JUMPTO/B", "(when (Eq X 1) (JUMPTO B))"),
            ("DO/B,I=1,3", "(do B I 1 3)"),
            ("B)CONTIN", "B) (CONTIN)"),
            // Everywhere else the words are names.
            ("THEN=1", "(let THEN 1)"),
            ("ELSE=THEN+ENDIF", "(let ELSE (+ THEN ENDIF))"),
            ("ELSEIF(3)=5", "(let ELSEIF<3> 5)"),
            ("DO=CONTIN", "(let DO CONTIN)"),
            ("P=POINT/DO,ELSE", "(define P POINT DO ELSE)"),
            // Mistakes.
            ("IF(X.EQ.1)THEN B=2", "(error) !RunsOnAfterWord { word: \"THEN\" }"),
            ("IF(X.EQ.1)THENB=2", "(when (Eq X 1) (let THENB 2))"),
            ("ELSE B=2", "(error) !RunsOnAfterWord { word: \"ELSE\" }"),
            ("ENDIF A=1", "(error) !RunsOnAfterWord { word: \"ENDIF\" }"),
            ("ELSE/1", "(error) !RunsOnAfterWord { word: \"ELSE\" }"),
            ("THEN", "(error) !WordNotAllowed(\"THEN\")"),
            ("ELSE)X=1", "ELSE) (let X 1)"),
            ("IF(X)THEN", "(error) !RelationMissing"),
            ("IF()THEN", "(error) !ConditionMissing"),
            ("IF(X.EQ.1)", "(error) !ThenMissing { word: \"IF\" }"),
            ("ELSEIF(X.EQ.1)", "(error) !ThenMissing { word: \"ELSEIF\" }"),
            ("ELSEIF(X.EQ.1)B=2", "(error) !ThenMissing { word: \"ELSEIF\" }"),
            ("IF(A.EQ.1)ELSE", "(error) !ConditionalClause { word: \"ELSE\" }"),
            ("IF(A.EQ.1)IF(B.EQ.1)THEN", "(error) !ConditionalClause { word: \"IF\" }"),
        ],
    );
    for dialect in [Apt3, Apt4] {
        check(
            dialect,
            &[
                ("IF(X.EQ.1)THEN", "(error) !StructuredIf { word: \"THEN\" }"),
                ("ELSEIF(X.EQ.1)THEN", "(error) !StructuredIf { word: \"ELSEIF\" }"),
                ("ELSE", "(error) !StructuredIf { word: \"ELSE\" }"),
                ("ENDIF", "(error) !StructuredIf { word: \"ENDIF\" }"),
                ("THEN=ELSE", "(let THEN ELSE)"),
            ],
        );
    }
    check(Apt3, &[("DO/B,I=1,3", "(error) !NotInDialect { word: \"DO\", dialect: Apt4 }")]);
}

#[test]
fn text_statements() {
    check(
        Free,
        &[
            ("PARTNO  Bracket $ 5", "(text PARTNO \"  Bracket $ 5\")"),
            ("PPRINTFOO", "(text PPRINT \"FOO\")"),
            ("insert/G2", "(text INSERT \"/G2\")"),
            ("REMARKABLE=3", "(text REMARK \"ABLE=3\")"),
            ("TITLES", "(text TITLES \"\")"),
            ("  PARTNO X", "(text PARTNO \" X\")"),
            ("\tpprint/HELLO; you $", "(text PPRINT \"HELLO; you $\")"),
            ("  INSERT / G2", "(text INSERT \" G2\")"),
            ("  TITLES", "(text TITLES \"\")"),
            ("  PPRINTX=5", "(let PPRINTX 5)"),
        ],
    );
    for dialect in [Apt3, Apt4] {
        check(dialect, &[("  PARTNO X", "(error) !TextWordNotInColumnOne { word: \"PARTNO\" }")]);
    }
    let card = format!("{:<72}00010", "PARTNO A");
    check(Apt3, &[(&card, &format!("(text PARTNO \" A{}\")", " ".repeat(64)))]);
}

#[test]
fn cl_files() {
    check(
        Cl,
        &[
            ("GOTO  / 1.0, 2.0,$\n  -3.5", "(GOTO/ 1 2 (neg 3.5))"),
            ("  10.5,  20, -3", "(GOTO 10.5 20 (neg 3))"),
            ("TOOL PATH/PLANAR_PROFILE,TOOL,MILL_D10", "(TOOL PATH/ PLANAR_PROFILE 'TOOL MILL_D10)"),
            ("END-OF-PATH", "(END-OF-PATH)"),
            ("N12   , SPINDL/ RPM, 3600., CLW", "(SPINDL/ 'RPM 3600 'CLW)"),
            ("C15     GOTO/ 2., 0., 0.", "(GOTO/ 2 0 0)"),
            ("PPRINT/'POCKET DEMO'", "(text PPRINT \"POCKET DEMO\")"),
            ("PARTNO / MFG0031", "(text PARTNO \"MFG0031\")"),
            ("N5    , PPRINT FIRST ~\nSECOND", "(text PPRINT \"FIRST ~\\nSECOND\")"),
            (
                "DISPLY/PUT ON THE CLAMP, 3 mm \"left\"",
                "(text DISPLY \"PUT ON THE CLAMP, 3 mm \\\"left\\\"\")",
            ),
            ("DISPLY/OFF", "(DISPLY/ 'OFF)"),
            ("DISPLY/NIXIE,3", "(DISPLY/ 'NIXIE 3)"),
            ("MACHIN/GENERIC 3X", "(MACHIN/ \"GENERIC 3X\")"),
            ("CIRCLE / 1, 2, 3, 0, 0, 1, 25", "(CIRCLE/ 1 2 3 0 0 1 25)"),
            ("TOOLNO/1,,20", "(TOOLNO/ 1 _ 20)"),
            ("OP_NAME/'A $ B',3", "(?OP_NAME/ \"A $ B\" 3)"),
            (
                "TLON,GOFWD/ (CIRCLE/ 1, 2, 3,$\n 4),ON,(LINE/ 1,2,3,$\n 4,5,6)",
                "(TLON) ; (GOFWD/ [CIRCLE 1 2 3 4] 'ON [LINE 1 2 3 4 5 6])",
            ),
            ("COOLNT/flood", "(COOLNT/ 'FLOOD)"),
            ("RETRCT/ON", "(RETRCT/ 'ON)"),
            ("$$-> CSYS / 1, $\n 0, 1", ""),
        ],
    );
}
