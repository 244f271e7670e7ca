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

syntax keyword aptText INSERT PARTNO PPRINT REMARK TITLES

syntax keyword aptMotion GOBACK GODLTA GODOWN INDIRP INDIRV OFFSET POCKET SRFVCT GOFWD GOLFT
syntax keyword aptMotion GORGT FROM GOTO GOUP PSIS GO

syntax keyword aptToolPosition TLNDON TLOFPS TLONPS TLLFT TLRGT TLON

syntax keyword aptPathParameter CUTTER NUMPTS OUTTOL TLAXIS INTOL MAXDP THICK TOLER

syntax keyword aptPathControl 2DCALC 3DCALC AUTOPS BEVELS DNTCUT GOUGCK MULTAX NDTEST DMILL NOPS
syntax keyword aptPathControl CUT

syntax keyword aptLogic JUMPTO LOOPND LOOPST TERMAC TRANTO LIBRY MACRO CALL FINI IF

syntax keyword aptDeclaration OBTAIN REFSYS RESERV CANON ZSURF SYN

syntax keyword aptTransformation MACHIN TRACUT INDEX COPY

syntax keyword aptInputOutput PRINT PUNCH READ

syntax keyword aptSystemFlag CLPRNT DYNDMP NOPLOT NOPOST PTONLY TANCRV TUNEUP DEBUG CLTV CMIT
syntax keyword aptSystemFlag SEC1 SEC2 DAC LTV MIT

syntax keyword aptGeometricType CIRCLE CONSEC CYLNDR ELLIPS ELMSRF GCONIC HYPERB LCONIC MATRIX PATERN
syntax keyword aptGeometricType POLCON QADRIC RLDSRF SPHERE TABCYL VECTOR PLANE POINT CONE LINE
syntax keyword aptGeometricType LOFT MESH TOOL

syntax keyword aptFunction ATAN2F LOG10F ANGLF ATANF DISTF LNTHF SQRTF ABSF COSF DOTF
syntax keyword aptFunction EXPF LOGF NUMF SINF TANF

syntax keyword aptPostprocessor ARCSLP ASLOPE AUXFUN CAMERA CLEARP CLRSRF COOLNT CORNFD COUPLE CUTCOM
syntax keyword aptPostprocessor DELETE DISPLY FEDRAT INTCOD LEADER LETTER LOADTL LPRINT MAGTAP MAXDPM
syntax keyword aptPostprocessor MAXVEL MCHFIN MCHTOL MDWRIT MOVETO OPSKIP ORIGIN OVPLOT PIVOTZ PLABEL
syntax keyword aptPostprocessor PLUNGE PREFUN REGBRK REVERS REWIND ROTABL ROTHED SAFETY SELCTL SLOWDN
syntax keyword aptPostprocessor SPINDL THREAD TOOLNO TURRET VTLAXS CHECK CLAMP CYCLE DELAY DRAFT
syntax keyword aptPostprocessor DWELL MDEND PITCH POSTN PPLOT SEQNO TMARK TRANS WCORN HEAD
syntax keyword aptPostprocessor IFRO MODE PLOT AIR PBS

syntax keyword aptPostprocessorBare DRAWLI FACEML GOCLER GOHOME OPSTOP PENDWN PICKUP RETRCT SWITCH ULOCKX
syntax keyword aptPostprocessorBare UNLOAD DRESS ISTOP LOCKX PENUP PROBX PROBY RAPID RESET STOP
syntax keyword aptPostprocessorBare ZERO END

syntax keyword aptMinor 3PT2SL 4PT1SL ADJUST ANTSPI ATANGL BINARY CENTER CIRCUL CIRLIN COLLET
syntax keyword aptMinor CUTANG DOTTED ENDARC FOURPT FUNOFY GAPLES HOLDER INTENS INTERC INVERS
syntax keyword aptMinor LENGTH LINCIR LINEAR MANUAL MAXIPM MAXRPM MEDIUM MIRROR MODIFY MULTRD
syntax keyword aptMinor NOMORE NORMAL NORMDS NORMPS OPTION PARLEL PERPTO PTNORM PTSLOP RADIUS
syntax keyword aptMinor RANDOM RETAIN ROTREF RTHETA SADDLE SCRIBE SETANG SETOOL SPLINE TAPKUL
syntax keyword aptMinor THETAR TRANSL TRFORM XCOORD XLARGE XSMALL XYPLAN XYVIEW YCOORD YLARGE
syntax keyword aptMinor YSMALL YZPLAN YZVIEW ZCOORD ZIGZAG ZLARGE ZSMALL ZXPLAN ZXVIEW AAXIS
syntax keyword aptMinor AVOID BAXIS BLACK CAXIS CHUCK CONST CROSS DITTO DRILL DSTAN
syntax keyword aptMinor FLOOD FRONT GREEN INTOF LARGE LIGHT MINUS NIXIE PARAB PERSP
syntax keyword aptMinor PSTAN RANGE RIGHT SCALE SLOPE SMALL SOLID START TANDS TANON
syntax keyword aptMinor TANTO TIMES TWOPT XAXIS XYROT YAXIS YZROT ZAXIS ZXROT AUTO
syntax keyword aptMinor BLUE BORE BOTH CCLW DARK DASH DECR DEEP DOWN FACE
syntax keyword aptMinor FULL GRID HIGH INCR LAST LEFT LITE LOCK MAIN MILL
syntax keyword aptMinor MIST NEGX NEGY NEGZ NEXT OMIT OPEN PART PAST PLUS
syntax keyword aptMinor POSX POSY POSZ RAIL REAM REAR SAME SIDE STEP THRU
syntax keyword aptMinor TRAV TURN TYPE UNIT 5PT ALL ARC BCD CAM CLW
syntax keyword aptMinor FAN IPM IPR LOW MED NOW NOX NOY NOZ OFF
syntax keyword aptMinor OUT PEN RED REV RPM SFM TAP TPI XYZ AT
syntax keyword aptMinor IN ON TO UP

" The rest of the card is text: behind columns 1-6, or in CL files behind a blank or slash.
syntax match aptTextLine /\%(^\%(INSERT\|PARTNO\|PPRINT\|REMARK\|TITLES\)\)\@<=.*$/
syntax match aptTextLine /\%(^\s\+\%(INSERT\|PARTNO\|PPRINT\|REMARK\|TITLES\)\)\@<=[ \t\/].*$/
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
