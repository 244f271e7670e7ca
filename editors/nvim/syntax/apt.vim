" Made from vocabulary.toml by `cargo xtask codegen`; do not edit.
if exists('b:current_syntax')
  finish
endif
syntax case ignore
syntax iskeyword @,48-57,_

syntax match aptSymbol /\<[A-Za-z0-9_]\+\>/
syntax match aptNumber /\<\d\+\>/
syntax match aptNumber /\<\d\+\.\d*\%(E[-+]\=\d\+\)\=/
syntax match aptNumber /\%(\w\)\@<!\.\d\+\%(E[-+]\=\d\+\)\=/
syntax match aptOperator /\*\*\|[-+*=]/
syntax match aptLabel /^\s*\w\+\s*)/
syntax match aptDefinition /^\s*\w\+\ze\s*\%(([^()=]*)\)\=\s*=/
syntax match aptMacro /^\s*\w\+\ze\s*=\s*MACRO\>/
syntax match aptCalled /\%(\<CALL\s*\/\s*\)\@<=\w\+/

syntax keyword aptText INSERT PARTNO PPRINT REMARK TITLES TPRINT

syntax keyword aptMotion GCLEAR GOBACK GODLTA GODOWN GOMILL INDIRP INDIRV OFFSET POCKET SRFVCT
syntax keyword aptMotion GOFWD GOLFT GORGT FROM GOTO GOUP PSIS SMIL GO

syntax keyword aptToolPosition TLNDON TLOFPS TLONPS TLLFT TLRGT TLON

syntax keyword aptPathParameter AVCTRL CHKSRF CUTTER INTSEC NUMPTS OUTTOL TLAXIS INTOL MAXDP THICK
syntax keyword aptPathParameter TOLER SCON

syntax keyword aptPathControl 2DCALC 3DCALC AUTOPS BEVELS DNTCUT GOUGCK MULTAX NDTEST DMILL NOPS
syntax keyword aptPathControl CUT

syntax keyword aptLogic CONTIN ELSEIF JUMPTO LOOPND LOOPST TERMAC TRANTO ENDIF LIBRY MACRO
syntax keyword aptLogic CALL ELSE FINI DO IF

syntax keyword aptDeclaration OBTAIN REFSYS RESERV CANON ZSURF SYN

syntax keyword aptTransformation MACHIN TRACUT INDEX COPY

syntax keyword aptInputOutput INCLUD PRINT PUNCH READ

syntax keyword aptSystemFlag CLPRNT DYNDMP LIBPRT NOPLOT NOPOST PTONLY SSTEST TABPRT TANCRV TUNEUP
syntax keyword aptSystemFlag AVMSG AVPRT DEBUG SSPRT CLTV CMIT SEC1 SEC2 DAC LTV
syntax keyword aptSystemFlag MIT

syntax keyword aptGeometricType CIRCLE CONSEC CYLNDR ELLIPS ELMSRF GCONIC HYPERB LCONIC MATRIX PATERN
syntax keyword aptGeometricType POLCON QADRIC RLDSRF SPHERE TABCYL VECTOR PLANE POINT SCURV SSURF
syntax keyword aptGeometricType CONE LINE LOFT MESH TOOL

syntax keyword aptFunction ARCOSB ARCOSF ARSINB ARSINF ATAN2B ATAN2F CLDATF COTANB COTANF LOG10F
syntax keyword aptFunction ANGLB ANGLF ATANB ATANF COSHF DISTF LNTHF PARMF SIGNF SINHF
syntax keyword aptFunction SPATF SQRTF TANHF ABSF CANF COSB COSF DOTF EXPF INTF
syntax keyword aptFunction LOGF MAXF MINF MODF NUMF SINB SINF TANB TANF

syntax keyword aptPostprocessor TOOL PATH ARCDAT ARCMOV ARCSLP ASLOPE AUXFUN CALSUB CAMERA CLEARP CLRSRF
syntax keyword aptPostprocessor COOLNT CORNFD COUPLE CUTCOM DEFSUB DELETE DISPLY ENDSUB FEDRAT INTCOD
syntax keyword aptPostprocessor LEADER LETTER LINTOL LOADTL LPRINT MAGTAP MAXDPM MAXVEL MCHFIN MCHTOL
syntax keyword aptPostprocessor MDWRIT MOVARC MOVETO MOVNRB OFSTNO OPSKIP ORIGIN OVPLOT PALLET PIVOTZ
syntax keyword aptPostprocessor PLABEL PLUNGE POSITN PREFUN REGBRK REVERS REWIND ROTABL ROTATE ROTHED
syntax keyword aptPostprocessor SAFETY SELCTL SELECT SLOWDN SMOOTH SPINDL THREAD TLDATA TOOLNO TURRET
syntax keyword aptPostprocessor VTLAXS ALIGN BREAK CHECK CLAMP CYCLE DELAY DRAFT DWELL MDEND
syntax keyword aptPostprocessor PAINT PITCH POSTN PPFUN PPLOT PPTOL SEQNO TMARK TRANS UNITS
syntax keyword aptPostprocessor WCORN DMIS HEAD IFRO LOAD MODE MSYS PLOT AIR PBS
syntax keyword aptPostprocessor SET
syntax match aptPostprocessor /\<END-OF-PATH\>/

syntax keyword aptPostprocessorBare DRAWLI FACEML GOCLER GOHOME OPSTOP PENDWN PICKUP RETRCT SWITCH ULOCKX
syntax keyword aptPostprocessorBare UNLOAD DRESS ISTOP LOCKX PENUP PROBX PROBY RAPID RESET STOP
syntax keyword aptPostprocessorBare ZERO END

syntax keyword aptMinor 3PT2SL 4PT1SL ADJUST ANTSPI ATANGL BINARY BINORM BRKCHP CENTER CIRCUL
syntax keyword aptMinor CIRLIN COLLET COMBIN CRSSPL CURSEG CUTANG DEGREE DIAMTR DOTTED ENDARC
syntax keyword aptMinor FOURPT FUNOFY GAPLES GENCUR HOLDER INCHES INTENS INTERC INVERS LENGTH
syntax keyword aptMinor LINCIR LINEAR MANUAL MAXIPM MAXRPM MEDIUM MIRROR MODIFY MULTRD NOMORE
syntax keyword aptMinor NORMAL NORMDS NORMPS OPTION ORIENT OSETNO PARLEL PERMIN PERPTO PERREV
syntax keyword aptMinor PICKFD PNTSON PNTVEC POLYGN PTNORM PTSLOP RADIUS RANDOM REPEAT RETAIN
syntax keyword aptMinor RETURN REVOLV ROTREF RTHETA RTRCTO SADDLE SCRIBE SETANG SETOOL SPLINE
syntax keyword aptMinor STEPOV TANSPL TAPKUL THETAR TRANSL TRFORM UPARAM VPARAM WEIGHT XCOORD
syntax keyword aptMinor XLARGE XSMALL XYPLAN XYVIEW YCOORD YLARGE YSMALL YZPLAN YZVIEW ZCOORD
syntax keyword aptMinor ZIGZAG ZLARGE ZSMALL ZXPLAN ZXVIEW AAXIS ABSOL ANGLE AVOID BAXIS
syntax keyword aptMinor BLACK BORE7 BORE8 BORE9 CAXIS CBORE CHORD CHUCK CLEAR CONST
syntax keyword aptMinor CROSS CSINK DEPTH DITTO DRILL DSTAN FEDTO FETCH FLOOD FRONT
syntax keyword aptMinor GMESH GREEN INTOF KNOTS LARGE LIGHT LIMIT MINUS NIXIE NURBS
syntax keyword aptMinor PARAB PARAM PATCH PERSP PSTAN RANGE RAPTO RIGHT RULED SCALE
syntax keyword aptMinor SHIFT SLOPE SMALL SMESH SOLID START TANDS TANON TANTO TIMES
syntax keyword aptMinor TWOPT XAXIS XYROT YAXIS YZROT ZAXIS ZXROT AUTO AXIS BLUE
syntax keyword aptMinor BORE BOTH CCLW DARK DASH DECR DEEP DOWN FACE FEED
syntax keyword aptMinor FLOW FULL GRID HIGH INCH INCR INIT LAST LEAD LEFT
syntax keyword aptMinor LITE LOCK MAIN MILL MIST MMPM MMPR NEGX NEGY NEGZ
syntax keyword aptMinor NEXT OMIT OPEN PART PAST PATH PLUS POSN POSX POSY
syntax keyword aptMinor POSZ PVAL RAIL REAM REAR SAME SIDE STEP SVAL THEN
syntax keyword aptMinor THRU TRAV TURN TVAL TYPE UNIT UVAL VVAL 5PT ALL
syntax keyword aptMinor ARC BCD CAM CLW FAN FPM FPR IPM IPR LAG
syntax keyword aptMinor LOW MED NOW NOX NOY NOZ OFF OUT PEN PTS
syntax keyword aptMinor RED REV RPM SEG SFM SMM TAP TPI XYZ AT
syntax keyword aptMinor CM DS IN MM ON PS TO UP

" The rest of the card is text: behind columns 1-6, or in CL files behind a blank or slash.
syntax match aptTextLine /\%(^\%(INSERT\|PARTNO\|PPRINT\|REMARK\|TITLES\|TPRINT\)\)\@<=.*$/
syntax match aptTextLine /\%(^\s\+\%(INSERT\|PARTNO\|PPRINT\|REMARK\|TITLES\|TPRINT\)\)\@<=[ \t\/].*$/
syntax match aptContinuation /\$.*$/
syntax match aptComment /\$\s*\$.*$/

highlight default link aptText PreProc
highlight default link aptMotion Statement
highlight default link aptToolPosition Statement
highlight default link aptPathParameter Keyword
highlight default link aptPathControl Keyword
highlight default link aptLogic Conditional
highlight default link aptDeclaration StorageClass
highlight default link aptTransformation Keyword
highlight default link aptInputOutput Keyword
highlight default link aptSystemFlag PreProc
highlight default link aptGeometricType Type
highlight default link aptFunction Function
highlight default link aptPostprocessor Special
highlight default link aptPostprocessorBare Special
highlight default link aptMinor Constant
highlight default link aptNumber Number
highlight default link aptOperator Operator
highlight default link aptLabel Label
highlight default link aptDefinition Identifier
highlight default link aptMacro Function
highlight default link aptCalled Function
highlight default link aptTextLine String
highlight default link aptContinuation Comment
highlight default link aptComment Comment

let b:current_syntax = 'apt'
