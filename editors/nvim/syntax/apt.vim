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

syntax keyword aptMinor 3PT2SL 4PT1SL ADJUST ANTSPI ATANGL BINARY BRKCHP CENTER CIRCUL CIRLIN
syntax keyword aptMinor COLLET COMBIN CRSSPL CURSEG CUTANG DIAMTR DOTTED ENDARC FOURPT FUNOFY
syntax keyword aptMinor GAPLES GENCUR HOLDER INCHES INTENS INTERC INVERS LENGTH LINCIR LINEAR
syntax keyword aptMinor MANUAL MAXIPM MAXRPM MEDIUM MIRROR MODIFY MULTRD NOMORE NORMAL NORMDS
syntax keyword aptMinor NORMPS OPTION ORIENT OSETNO PARLEL PERMIN PERPTO PERREV PICKFD PNTVEC
syntax keyword aptMinor POLYGN PTNORM PTSLOP RADIUS RANDOM RETAIN RETURN REVOLV ROTREF RTHETA
syntax keyword aptMinor RTRCTO SADDLE SCRIBE SETANG SETOOL SPLINE STEPOV TANSPL TAPKUL THETAR
syntax keyword aptMinor TRANSL TRFORM WEIGHT XCOORD XLARGE XSMALL XYPLAN XYVIEW YCOORD YLARGE
syntax keyword aptMinor YSMALL YZPLAN YZVIEW ZCOORD ZIGZAG ZLARGE ZSMALL ZXPLAN ZXVIEW AAXIS
syntax keyword aptMinor ABSOL ANGLE AVOID BAXIS BLACK CAXIS CHORD CHUCK CLEAR CONST
syntax keyword aptMinor CROSS CSINK DEPTH DITTO DRILL DSTAN FEDTO FLOOD FRONT GREEN
syntax keyword aptMinor INTOF LARGE LIGHT LIMIT MINUS NIXIE PARAB PARAM PATCH PERSP
syntax keyword aptMinor PSTAN RANGE RAPTO RIGHT RULED SCALE SLOPE SMALL SMESH SOLID
syntax keyword aptMinor START TANDS TANON TANTO TIMES TWOPT XAXIS XYROT YAXIS YZROT
syntax keyword aptMinor ZAXIS ZXROT AUTO AXIS BLUE BORE BOTH CCLW DARK DASH
syntax keyword aptMinor DECR DEEP DOWN FACE FEED FLOW FULL GRID HIGH INCH
syntax keyword aptMinor INCR INIT LAST LEAD LEFT LITE LOCK MAIN MILL MIST
syntax keyword aptMinor MMPM MMPR NEGX NEGY NEGZ NEXT OMIT OPEN PART PAST
syntax keyword aptMinor PATH PLUS POSN POSX POSY POSZ RAIL REAM REAR SAME
syntax keyword aptMinor SIDE STEP THEN THRU TRAV TURN TYPE UNIT 5PT ALL
syntax keyword aptMinor ARC BCD CAM CLW FAN FPM FPR IPM IPR LAG
syntax keyword aptMinor LOW MED NOW NOX NOY NOZ OFF OUT PEN RED
syntax keyword aptMinor REV RPM SEG SFM SMM TAP TPI XYZ AT CM
syntax keyword aptMinor DS IN MM ON PS TO UP

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
