//! Every form of every definition, with values computed by hand.

mod support;

use std::collections::BTreeSet;

use apt_geometry::canonical::GeometryKind;
use apt_geometry::definition::{Argument, formats, matching_format};
use support::{Session, difference};

/// Values are written with up to nine decimals.
const TOLERANCE: f64 = 1e-9;

/// Entities that the rows use.
const BASE: &[&str] = &[
    "LX=LINE/XAXIS",
    "LY=LINE/YAXIS",
    "L0=LINE/0,0,4,3",
    "C2=CIRCLE/0,0,2",
    "CA=CIRCLE/0,0,1",
    "CB=CIRCLE/4,0,1",
    "C5=CIRCLE/0,0,5",
    "CC=CIRCLE/3,0,1",
    "PLX=PLANE/1,0,0,1",
    "PLY=PLANE/0,1,0,2",
    "PLZ=PLANE/0,0,1,3",
    "V1=VECTOR/0,3,4",
    "VX=VECTOR/2,0,0",
    "VY=VECTOR/0,3,0",
    "VZ=VECTOR/0,0,1",
    "E1=ELLIPS/CENTER,(0,0),4,2,0",
    "G1=GCONIC/1,0,0,0,-4,0",
    "M1=MATRIX/TRANSL,5,0,0",
    "M2=MATRIX/XYROT,90",
    "T1=TABCYL/NOZ,PTSLOP,0,0,1,4,0,-1",
    "T2=TABCYL/NOZ,PTSLOP,0,0,0,4,0,0",
    "PA=PATERN/LINEAR,(0,0),(6,3),4",
    "PB=PATERN/LINEAR,(0,0),VY,2",
];

#[expect(clippy::approx_constant, reason = "tables are read by their digits")]
#[rustfmt::skip]
const ROWS: &[(&str, &[f64])] = &[
    ("POINT/1,2", &[1.0, 2.0, 0.0]),
    ("POINT/1,2,3", &[1.0, 2.0, 3.0]),
    ("POINT/INTOF,LX,LY", &[0.0, 0.0, 0.0]),
    ("POINT/YLARGE,INTOF,L0,C5", &[4.0, 3.0, 0.0]),
    ("POINT/XSMALL,INTOF,L0,C5", &[-4.0, -3.0, 0.0]),
    ("POINT/YSMALL,INTOF,C5,(CIRCLE/6,0,5)", &[3.0, -4.0, 0.0]),
    ("POINT/XLARGE,INTOF,CA,(CIRCLE/3,0,2)", &[1.0, 0.0, 0.0]),
    ("POINT/XLARGE,INTOF,C5,(CIRCLE/-3,0,2)", &[-5.0, 0.0, 0.0]),
    ("POINT/C2,ATANGL,90", &[0.0, 2.0, 0.0]),
    ("POINT/CENTER,CB", &[4.0, 0.0, 0.0]),
    ("POINT/XLARGE,INTOF,LX,E1", &[4.0, 0.0, 0.0]),
    ("POINT/YSMALL,INTOF,LY,E1", &[0.0, -2.0, 0.0]),
    ("POINT/YLARGE,INTOF,(LINE/2,0,2,5),G1", &[2.0, 1.0, 0.0]),
    ("POINT/YLARGE,INTOF,LX,G1", &[0.0, 0.0, 0.0]),
    ("POINT/XLARGE,INTOF,LX,(QADRIC/1,1,1,0,0,0,0,0,0,-9)", &[3.0, 0.0, 0.0]),
    ("POINT/INTOF,PLX,PLY,PLZ", &[1.0, 2.0, 3.0]),
    ("POINT/RTHETA,ZXPLAN,2,90", &[2.0, 0.0, 0.0]),
    ("POINT/THETAR,YZPLAN,90,2", &[0.0, 0.0, 2.0]),
    ("POINT/INTOF,(LINE/2,0,2,5),T1,(2,1)", &[2.0, 1.0, 0.0]),
    ("POINT/INTOF,(LINE/-1,0,-1,5),T1,(0,0)", &[-1.0, -1.0, 0.0]),
    ("POINT/PA,3", &[4.0, 2.0, 0.0]),
    ("LINE/0,0,3,4", &[0.8, -0.6, 0.0, 0.0]),
    ("LINE/0,0,5,3,4,9", &[0.8, -0.6, 0.0, 0.0]),
    ("LINE/(1,2),(1,5)", &[1.0, 0.0, 0.0, 1.0]),
    ("LINE/(5,0),LEFT,TANTO,(CIRCLE/0,0,4)", &[-0.8, 0.6, 0.0, -4.0]),
    ("LINE/(5,0),RIGHT,TANTO,(CIRCLE/0,0,4)", &[-0.8, -0.6, 0.0, -4.0]),
    ("LINE/(3,4),LEFT,TANTO,C2", &[-0.973212111, 0.229909083, 0.0, -2.0]),
    ("LINE/LEFT,TANTO,CA,LEFT,TANTO,CB", &[0.0, -1.0, 0.0, -1.0]),
    ("LINE/LEFT,TANTO,CA,RIGHT,TANTO,CB", &[0.5, 0.866025404, 0.0, 1.0]),
    ("LINE/(1,2),ATANGL,90", &[-1.0, 0.0, 0.0, -1.0]),
    ("LINE/(1,2),ATANGL,90,YAXIS", &[0.0, 1.0, 0.0, 2.0]),
    ("LINE/(1,2),ATANGL,90,L0", &[0.8, 0.6, 0.0, 2.0]),
    ("LINE/(1,2),SLOPE,1", &[-0.707106781, 0.707106781, 0.0, 0.707106781]),
    ("LINE/(1,2),SLOPE,1,XAXIS", &[-0.707106781, 0.707106781, 0.0, 0.707106781]),
    ("LINE/(1,2),SLOPE,1,YAXIS", &[0.707106781, 0.707106781, 0.0, 2.121320344]),
    ("LINE/(1,2),SLOPE,1,LX", &[-0.707106781, 0.707106781, 0.0, 0.707106781]),
    ("LINE/YAXIS", &[1.0, 0.0, 0.0, 0.0]),
    ("LINE/(1,2),PARLEL,L0", &[0.6, -0.8, 0.0, -1.0]),
    ("LINE/(1,2),PERPTO,L0", &[0.8, 0.6, 0.0, 2.0]),
    ("LINE/PARLEL,L0,XSMALL,2", &[-0.6, 0.8, 0.0, 2.0]),
    ("LINE/PARLEL,L0,YSMALL,-2", &[0.6, -0.8, 0.0, -2.0]),
    ("LINE/INTOF,PLX,PLZ", &[1.0, 0.0, 0.0, 1.0]),
    ("LINE/SLOPE,1,INTERC,2", &[-0.707106781, 0.707106781, 0.0, 1.414213562]),
    ("LINE/SLOPE,1,INTERC,XAXIS,2", &[-0.707106781, 0.707106781, 0.0, -1.414213562]),
    ("LINE/ATANGL,45,INTERC,2", &[-0.707106781, 0.707106781, 0.0, 1.414213562]),
    ("LINE/ATANGL,45,INTERC,YAXIS,2", &[-0.707106781, 0.707106781, 0.0, 1.414213562]),
    ("LINE/(2,1.5),TANTO,T1,(0,0)", &[0.577350269, -0.816496581, 0.0, -0.070044333]),
    ("LINE/(2,3),PERPTO,T1,(2,1)", &[1.0, 0.0, 0.0, 2.0]),
    ("PLANE/0,0,2,3", &[0.0, 0.0, 1.0, 1.5]),
    ("PLANE/(1,0,0),(0,1,0),(0,0,1)", &[0.577350269, 0.577350269, 0.577350269, 0.577350269]),
    ("PLANE/(1,2,3),PARLEL,PLZ", &[0.0, 0.0, 1.0, 3.0]),
    ("PLANE/PARLEL,PLZ,ZSMALL,1", &[0.0, 0.0, -1.0, -2.0]),
    ("PLANE/(0,0,5),PERPTO,V1", &[0.0, 0.6, 0.8, 4.0]),
    ("PLANE/PERPTO,PLZ,(1,0,0),(1,4,7)", &[1.0, 0.0, 0.0, 1.0]),
    ("PLANE/(1,4,7),(1,0,0),PERPTO,PLZ", &[-1.0, 0.0, 0.0, -1.0]),
    ("PLANE/(1,1,1),(2,3,2),(3,4,0)", &[-0.845154255, 0.507092553, -0.169030851, -0.507092553]),
    ("SPHERE/(0,0,0),(1,1,1),(2,3,2),(3,4,0)", &[-3.166666667, 5.5, -0.833333333, 6.400954789]),
    ("ELLIPS/CENTER,(1,1,1),3,2,30", &[5.25, 7.75, 0.0, -27.330127019, 0.0, 0.0, -2.165063509, -3.084936491, -5.584936491, 0.0]),
    ("PLANE/(7,8,9),PERPTO,PLX,PLY", &[0.0, 0.0, 1.0, 9.0]),
    ("CIRCLE/1,2,3", &[1.0, 2.0, 0.0, 0.0, 0.0, 1.0, 3.0]),
    ("CIRCLE/1,2,9,3", &[1.0, 2.0, 0.0, 0.0, 0.0, 1.0, 3.0]),
    ("CIRCLE/CENTER,(1,2,9),RADIUS,3", &[1.0, 2.0, 0.0, 0.0, 0.0, 1.0, 3.0]),
    ("CIRCLE/CENTER,1,2,9,RADIUS,3", &[1.0, 2.0, 0.0, 0.0, 0.0, 1.0, 3.0]),
    ("CIRCLE/CENTER,(1,2),TANTO,L0", &[1.0, 2.0, 0.0, 0.0, 0.0, 1.0, 1.0]),
    ("CIRCLE/CENTER,(1,2),(4,6,9)", &[1.0, 2.0, 0.0, 0.0, 0.0, 1.0, 5.0]),
    ("CIRCLE/(0,0),(4,0),(0,2)", &[2.0, 1.0, 0.0, 0.0, 0.0, 1.0, 2.236067977]),
    ("CIRCLE/CENTER,(9,0),SMALL,TANTO,C5", &[9.0, 0.0, 0.0, 0.0, 0.0, 1.0, 4.0]),
    ("CIRCLE/XLARGE,LY,YSMALL,LX,RADIUS,.5", &[0.5, -0.5, 0.0, 0.0, 0.0, 1.0, 0.5]),
    ("CIRCLE/TANTO,LX,XLARGE,(0,1),RADIUS,1", &[1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0]),
    ("CIRCLE/TANTO,LX,YSMALL,(3,0),RADIUS,1", &[3.0, -1.0, 0.0, 0.0, 0.0, 1.0, 1.0]),
    ("CIRCLE/TANTO,LX,XLARGE,(3,2),RADIUS,1", &[3.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0]),
    ("CIRCLE/YLARGE,LX,XSMALL,OUT,C5,RADIUS,1", &[-5.916079783, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0]),
    ("CIRCLE/YLARGE,OUT,CA,OUT,CB,RADIUS,1.5", &[2.0, 1.5, 0.0, 0.0, 0.0, 1.0, 1.5]),
    ("CIRCLE/YLARGE,IN,C5,OUT,CC,RADIUS,1", &[3.5, 1.936491673, 0.0, 0.0, 0.0, 1.0, 1.0]),
    ("CIRCLE/TANTO,LY,XLARGE,T2,YLARGE,(1,0),RADIUS,1", &[1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0]),
    ("CYLNDR/1,2,3,0,3,4,2", &[1.0, 2.0, 3.0, 0.0, 0.6, 0.8, 2.0]),
    ("CYLNDR/(1,2,3),0,3,4,2", &[1.0, 2.0, 3.0, 0.0, 0.6, 0.8, 2.0]),
    ("CYLNDR/1,2,3,V1,2", &[1.0, 2.0, 3.0, 0.0, 0.6, 0.8, 2.0]),
    ("CYLNDR/(1,2,3),V1,2", &[1.0, 2.0, 3.0, 0.0, 0.6, 0.8, 2.0]),
    ("CONE/(1,2,3),V1,60", &[1.0, 2.0, 3.0, 0.0, 0.6, 0.8, 0.5]),
    ("SPHERE/1,2,3,4", &[1.0, 2.0, 3.0, 4.0]),
    ("SPHERE/(1,2,3),4", &[1.0, 2.0, 3.0, 4.0]),
    ("SPHERE/CENTER,(1,2,3),RADIUS,4", &[1.0, 2.0, 3.0, 4.0]),
    ("SPHERE/CENTER,(1,2,3),(1,5,7)", &[1.0, 2.0, 3.0, 5.0]),
    ("SPHERE/CENTER,(5,2,3),TANTO,PLX", &[5.0, 2.0, 3.0, 4.0]),
    ("SPHERE/(1,0,0),(-1,0,0),(0,1,0),(0,0,1)", &[0.0, 0.0, 0.0, 1.0]),
    ("ELLIPS/CENTER,(0,0,9),4,2,90", &[16.0, 4.0, 0.0, -64.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
    ("HYPERB/CENTER,(0,0),4,2,0", &[4.0, -16.0, 0.0, -64.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
    ("GCONIC/1,2,3,4,5,6", &[1.0, 3.0, 0.0, 6.0, 0.0, 0.0, 1.0, 2.0, 2.5, 0.0]),
    ("GCONIC/2,3,4,5,6", &[0.0, 1.0, 0.0, 3.0, 0.0, 0.0, -2.0, 3.5, -3.0, 0.0]),
    ("GCONIC/2,3,4,5,6,FUNOFY", &[1.0, 0.0, 0.0, 3.0, 0.0, 0.0, -2.0, -3.0, 3.5, 0.0]),
    ("QADRIC/1,2,3,4,5,6,7,8,9,10", &[1.0, 2.0, 3.0, 10.0, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5]),
    ("VECTOR/1,2,3", &[1.0, 2.0, 3.0]),
    ("VECTOR/1,2,3,5,7,9", &[4.0, 5.0, 6.0]),
    ("VECTOR/(1,2,3),(5,7,9)", &[4.0, 5.0, 6.0]),
    ("VECTOR/PERPTO,PLY,NEGY", &[0.0, -1.0, 0.0]),
    ("VECTOR/2,TIMES,V1", &[0.0, 6.0, 8.0]),
    ("VECTOR/VX,CROSS,(0,1,0)", &[0.0, 0.0, 2.0]),
    ("VECTOR/UNIT,V1", &[0.0, 0.6, 0.8]),
    ("VECTOR/UNIT,0,3,4", &[0.0, 0.6, 0.8]),
    ("VECTOR/LENGTH,2,ATANGL,90,YZPLAN", &[0.0, 0.0, 2.0]),
    ("VECTOR/PARLEL,INTOF,PLX,PLY,NEGZ", &[0.0, 0.0, -1.0]),
    ("VECTOR/V1,MINUS,(1,1,1)", &[-1.0, 2.0, 3.0]),
    ("VECTOR/ATANGL,30,LX,POSX", &[0.866025404, 0.5, 0.0]),
    ("VECTOR/ATANGL,30,LX,YSMALL", &[-0.866025404, -0.5, 0.0]),
    ("MATRIX/1,2,3,4,5,6,7,8,9,10,11,12", &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0]),
    ("MATRIX/TRANSL,1,2", &[1.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 2.0, 0.0, 0.0, 1.0, 0.0]),
    ("MATRIX/TRANSL,1,2,3", &[1.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 2.0, 0.0, 0.0, 1.0, 3.0]),
    ("MATRIX/ZXROT,90", &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0]),
    ("MATRIX/SCALE,2", &[2.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0]),
    ("MATRIX/XYROT,90,TRANSL,1,2,3", &[0.0, -1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 2.0, 0.0, 0.0, 1.0, 3.0]),
    ("MATRIX/TRANSL,1,2,3,XYROT,90", &[0.0, -1.0, 0.0, -2.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 3.0]),
    ("MATRIX/M2,TRANSL,1,2", &[0.0, -1.0, 0.0, -2.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0]),
    ("MATRIX/SCALE,2,M1", &[2.0, 0.0, 0.0, 10.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0]),
    ("MATRIX/INVERS,M1", &[1.0, 0.0, 0.0, -5.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]),
    ("MATRIX/PLX,PLY,PLZ", &[1.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 2.0, 0.0, 0.0, 1.0, 3.0]),
    ("MATRIX/(1,2,3),VY,VX", &[0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 2.0, 0.0, 0.0, -1.0, 3.0]),
    ("MATRIX/MIRROR,ZXPLAN", &[1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]),
    ("MATRIX/MIRROR,ZXPLAN,XYPLAN", &[1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0]),
    ("MATRIX/MIRROR,YZPLAN,ZXPLAN,XYPLAN", &[-1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0]),
    ("MATRIX/MIRROR,PLX", &[-1.0, 0.0, 0.0, 2.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]),
    ("PATERN/LINEAR,(0,0),(6,3),2", &[1.0, 2.0, 2.0, 0.0, 0.0, 0.0, 6.0, 3.0, 0.0]),
    ("PATERN/LINEAR,(1,1),VX,2", &[1.0, 2.0, 2.0, 1.0, 1.0, 0.0, 3.0, 1.0, 0.0]),
    ("PATERN/LINEAR,(1,1),VX,INCR,2,AT,.5,3", &[1.0, 4.0, 4.0, 1.0, 1.0, 0.0, 1.5, 1.0, 0.0, 2.0, 1.0, 0.0, 5.0, 1.0, 0.0]),
    ("PATERN/ARC,C2,90,0,CLW,2", &[2.0, 2.0, 2.0, 0.0, 2.0, 0.0, 2.0, 0.0, 0.0]),
    ("PATERN/CIRCUL,C2,0,CLW,INCR,1,AT,90", &[2.0, 2.0, 2.0, 2.0, 0.0, 0.0, 0.0, -2.0, 0.0]),
    ("PATERN/PARLEL,PB,(PATERN/LINEAR,(1,0),VX,2)", &[4.0, 4.0, 2.0, 0.0, 0.0, 0.0, 0.0, 3.0, 0.0, 2.0, 3.0, 0.0, 2.0, 0.0, 0.0]),
    ("PATERN/GRID,PB,VX,2", &[4.0, 4.0, 2.0, 0.0, 0.0, 0.0, 0.0, 3.0, 0.0, 2.0, 3.0, 0.0, 2.0, 0.0, 0.0]),
    ("PATERN/PARLEL,PB,VX,INCR,1", &[4.0, 4.0, 2.0, 0.0, 0.0, 0.0, 0.0, 3.0, 0.0, 1.0, 3.0, 0.0, 1.0, 0.0, 0.0]),
    ("PATERN/RANDOM,(9,9,1),PB,(5,5)", &[3.0, 4.0, 4.0, 9.0, 9.0, 1.0, 0.0, 0.0, 0.0, 0.0, 3.0, 0.0, 5.0, 5.0, 0.0]),
    ("RLDSRF/PLZ,(0,0,3),(4,0,3),(2,1,3),(2,5,5)", &[3003.0, 0.0, 0.0, 1.0, 3.0, 3001.0, 0.0, 0.0, 3.0, 3001.0, 4.0, 0.0, 3.0, 3001.0, 0.0, 1.0, 0.0, 3001.0, 2.0, 5.0, 5.0]),
    ("RLDSRF/PLZ,(0,0,3),(4,0,3),VY,PLX,(0,9,3),(4,9,3),VZ", &[3003.0, 0.0, 0.0, 1.0, 3.0, 3001.0, 0.0, 0.0, 3.0, 3001.0, 4.0, 0.0, 3.0, 3011.0, 0.0, 1.0, 0.0, 3003.0, 1.0, 0.0, 0.0, 1.0, 3001.0, 0.0, 9.0, 3.0, 3001.0, 4.0, 9.0, 3.0, 3011.0, 0.0, 0.0, 1.0]),
    ("TABCYL/NOZ,PTSLOP,0,0,1,4,0,-1", &[4.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0,
        -7.071067812, -7.071067812, 0.0, 0.0, 10.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.25, 4.0, 0.25, 0.0,
        4.0, 0.0, 0.0, 0.0, 10.0, 0.0, 0.0, 11.071067812, -7.071067812]),
    ("TABCYL/NOZ,PTNORM,0,0,135,4,0,45", &[4.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0,
        -7.071067812, -7.071067812, 0.0, 0.0, 10.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.25, 4.0, 0.25, 0.0,
        4.0, 0.0, 0.0, 0.0, 10.0, 0.0, 0.0, 11.071067812, -7.071067812]),
    ("TABCYL/NOY,TWOPT,0,0,SLOPE,-1,(0,9,4),SLOPE,1", &[4.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0,
        7.071067812, 7.071067812, 0.0, 0.0, 10.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.25, 4.0, 0.0, -0.25,
        0.0, -4.0, 0.0, 0.0, 10.0, 0.0, 0.0, 7.071067812, -11.071067812]),
    ("TABCYL/NOZ,FOURPT,0,0,1,0,2,0,3,0", &[6.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0,
        -10.0, 0.0, 0.0, 0.0, 10.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0,
        2.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 10.0, 0.0, 0.0, 13.0, 0.0]),
    ("TABCYL/XYZ,SPLINE,VZ,0,0,7,(1,0,8),2,0,9", &[5.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0,
        -10.0, 0.0, 0.0, 0.0, 10.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0,
        2.0, 0.0, 0.0, 0.0, 10.0, 0.0, 0.0, 12.0, 0.0]),
    ("TABCYL/THETAR,SPLINE,TRFORM,M1,0,1,0,2,0,3", &[5.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0,
        -4.0, 0.0, 0.0, 0.0, 10.0, 0.0, 0.0, 6.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 7.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0,
        8.0, 0.0, 0.0, 0.0, 10.0, 0.0, 0.0, 18.0, 0.0]),
    ("CIRCLE/C2,CANON,,,,,,,.25", &[0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.25]),
    ("LINE/CANON,3,4,0,5", &[3.0, 4.0, 0.0, 5.0]),
    ("PLANE/PLX,CANON,0,0,2", &[0.0, 0.0, 1.0, 0.5]),
    ("CIRCLE/CANON,1,2,3,0,0,1,-4", &[1.0, 2.0, 3.0, 0.0, 0.0, 1.0, -4.0]),
];

/// Forms whose numbers are checked elsewhere: LCONIC up to a factor.
#[rustfmt::skip]
const CONICS: &[(&str, &[f64])] = &[
    ("LCONIC/5PT,(5,0),(4,3),(0,5),(-3,4),(-5,0)", &[1.0, 1.0, 0.0, -25.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
    ("LCONIC/5PT,5,0,4,3,0,5,-3,4,-5,0", &[1.0, 1.0, 0.0, -25.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
    ("LCONIC/4PT1SL,(0,5),0,(5,0),(-3,4),(-5,0)", &[1.0, 1.0, 0.0, -25.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
    ("LCONIC/3PT2SL,0,5,0,3,-4,.75,(-5,0)", &[1.0, 1.0, 0.0, -25.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
];

fn session() -> Session {
    let mut session = Session::new();
    for statement in BASE {
        session.run(statement).unwrap_or_else(|error| panic!("{statement}: {error:?}"));
    }
    session
}

#[test]
fn every_form_gives_its_values() {
    let session = session();
    let mut failures = Vec::new();
    for (body, expected) in ROWS {
        match session.body(body) {
            Ok(found) => {
                let values = found.canonical_values();
                if values.len() != expected.len() || difference(&values, expected) > TOLERANCE {
                    failures.push(format!("{body}:\n  {values:?}\n  {expected:?}"));
                }
            }
            Err(error) => failures.push(format!("{body}: {error:?}")),
        }
    }
    for (body, expected) in CONICS {
        let values =
            session.body(body).unwrap_or_else(|error| panic!("{body}: {error:?}")).canonical_values();
        let scaled: Vec<f64> = values.iter().map(|value| value / values[0]).collect();
        if difference(&scaled, expected) > TOLERANCE {
            failures.push(format!("{body}:\n  {scaled:?}\n  {expected:?}"));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// No form is left out of the tables.
#[test]
fn every_format_of_every_type_has_a_row() {
    let session = session();
    let mut seen = BTreeSet::new();
    for (body, _) in ROWS.iter().chain(CONICS) {
        let (word, parameters) = body.split_once('/').expect("a type");
        let kind = GeometryKind::from_word(word).expect("a type word");
        let kinds: Vec<_> =
            session.arguments(parameters).expect("arguments").iter().map(Argument::kind).collect();
        if let Some(format) = matching_format(kind, &kinds) {
            seen.insert((kind, format!("{:?}", format.parameters)));
        }
    }
    for kind in GeometryKind::all() {
        for format in formats(kind) {
            assert!(
                seen.contains(&(kind, format!("{:?}", format.parameters))),
                "{kind:?}: {} has no row",
                format.help
            );
            assert!(!format.help.is_empty());
        }
    }
}

/// A statement, the APT III number that it gives, and a word of the evidence.
const ERRORS: &[(&str, u16, &str)] = &[
    ("POINT/1", 1000, "UnknownFormat"),
    ("POINT/1,2,3,4,5", 1000, "UnknownFormat"),
    ("LINE/1,2", 1000, "UnknownFormat"),
    ("LINE/(1,2),C2", 1000, "UnknownFormat"),
    ("VECTOR/(1,2,3)", 1000, "UnknownFormat"),
    ("POLCON/1,2", 1000, "UnknownFormat"),
    ("POINT/ZLARGE,INTOF,L0,C2", 1003, "XLarge"),
    ("LINE/PARLEL,L0,RIGHT,2", 1003, "position: 2"),
    ("LINE/(1,2),PARLEL,C2", 1000, "UnknownFormat"),
    ("LINE/ZAXIS", 1003, "position: 0"),
    ("LINE/PARLEL,L0,ZLARGE,1", 1003, "position: 2"),
    ("LINE/(9,9),LARGE,TANTO,C2", 1003, "position: 1"),
    ("CIRCLE/YLARGE,LX,XSMALL,LARGE,C5,RADIUS,1", 1003, "position: 3"),
    ("MATRIX/XLARGE,90", 1003, "XyRotation"),
    ("VECTOR/PERPTO,PLX,POSZ", 1005, "Undecided"),
    ("POINT/INTOF,LX,(LINE/0,1,5,1)", 1005, "Parallel"),
    ("POINT/XLARGE,INTOF,LX,(CIRCLE/0,3,1)", 1005, "gap: 2.0"),
    ("POINT/YLARGE,INTOF,LX,C5", 1005, "Undecided"),
    ("POINT/XLARGE,INTOF,CA,CB", 1005, "NoIntersection"),
    ("POINT/XLARGE,INTOF,CA,C2", 1005, "Coincident"),
    ("POINT/XLARGE,INTOF,(LINE/0,9,1,9),E1", 1005, "NoIntersection"),
    ("POINT/INTOF,PLX,PLX,PLZ", 1005, "Singular"),
    ("POINT/PA,5", 154, "position: Some(1)"),
    ("POINT/PA,0", 154, "position: Some(1)"),
    ("LINE/1,2,1,2", 1005, "Coincident"),
    ("LINE/(1,0),LEFT,TANTO,C2", 1005, "InsideCircle"),
    ("LINE/LEFT,TANTO,CC,RIGHT,TANTO,C5", 1005, "InsideCircle"),
    ("LINE/INTOF,PLX,PLY", 1005, "Parallel"),
    ("LINE/INTOF,PLX,PLX", 1005, "Parallel"),
    ("LINE/PARLEL,LX,XLARGE,1", 1005, "Undecided"),
    ("PLANE/0,0,0,1", 1005, "ZeroVector"),
    ("PLANE/(0,0,0),(1,1,1),(2,2,2)", 1005, "Collinear"),
    ("PLANE/PERPTO,PLZ,(0,0,0),(0,0,1)", 1005, "Parallel"),
    ("PLANE/(0,0,0),PERPTO,PLX,PLX", 1005, "Parallel"),
    ("PLANE/(0,0,0),PERPTO,(VECTOR/0,0,0)", 1005, "ZeroVector"),
    ("CIRCLE/0,0,-1", 1005, "NotPositive"),
    ("CIRCLE/(0,0),(1,1),(3,3)", 1005, "Collinear"),
    ("CIRCLE/YLARGE,LX,YLARGE,LX,RADIUS,1", 1005, "Parallel"),
    ("CIRCLE/TANTO,LX,XLARGE,(0,3),RADIUS,1", 1005, "RadiusTooSmall { radius: 1.0, least: 1.5 }"),
    ("CIRCLE/YLARGE,OUT,CA,OUT,CB,RADIUS,.5", 1005, "RadiusTooSmall"),
    ("CYLNDR/0,0,0,0,0,0,1", 1005, "ZeroVector"),
    ("CONE/(0,0,0),VX,90", 1005, "AngleOutOfRange"),
    ("SPHERE/CENTER,(1,2,3),TANTO,PLX", 1005, "NotPositive"),
    ("SPHERE/(0,0,0),(1,0,0),(0,1,0),(1,1,0)", 1005, "Singular"),
    ("ELLIPS/CENTER,(0,0),0,1,0", 1005, "NotPositive"),
    ("LCONIC/5PT,0,0,1,1,2,2,3,3,4,4", 1005, "Collinear"),
    ("LCONIC/5PT,0,0,0,0,2,2,3,4,4,4", 1005, "Coincident"),
    ("VECTOR/UNIT,0,0,0", 1005, "ZeroVector"),
    ("MATRIX/(0,0,0),VX,VX", 1005, "Parallel"),
    ("MATRIX/INVERS,(MATRIX/SCALE,0)", 1005, "Singular"),
    ("TABCYL/NOZ,SPLINE,0,0,1,1", 1001, "Special"),
    ("TABCYL/NOZ,FOURPT,0,0,1,1,2,2", 1001, "Special"),
    ("TABCYL/NOZ,SPLINE,0,0,0,0,1,1", 1005, "Coincident"),
    ("TABCYL/XYZ,PTSLOP,VZ,0,0,0,1,1,1", 1000, "UnknownFormat"),
    ("PATERN/LINEAR,(0,0)", 800, "UnknownFormat"),
    ("PATERN/LINEAR,(0,0),VX,1000000000", 802, "Special"),
    ("PATERN/LINEAR,(0,0),VX,-1", 800, "Special"),
    ("PATERN/PARLEL,(PATERN/RANDOM,PA),VX,2", 801, "Special"),
    ("RLDSRF/PLZ,(0,0,3),(0,0,3.001),VY,(2,5,5)", 701, "Special"),
    ("RLDSRF/PLZ,(0,0,3),(4,0,3),VX,(2,5,5)", 702, "Special"),
    ("RLDSRF/PLZ,(0,0,3),(4,0,3),(2,0,3),(2,5,5)", 702, "Special"),
    ("RLDSRF/PLZ,(0,0,3)", 1002, "UnknownFormat"),
    ("POINT/CANON,1,2", 84, "expected: 3"),
    ("CIRCLE/C2,CANON,1,2,3,4,5,6,7,8", 84, "expected: 7"),
    ("CIRCLE/L0,CANON,1", 80, "found: Line"),
    ("CIRCLE/CANON,1,2,,0,0,1,4", 83, "Special"),
    ("CIRCLE/C2,CANON,LX", 83, "Special"),
    ("CIRCLE/C2,CANON,,,,,,,0", 1005, "NotPositive"),
    ("RLDSRF/CANON,1", 1002, "UnknownFormat"),
];

#[test]
fn impossible_and_malformed_definitions_say_why() {
    let session = session();
    for (body, number, evidence) in ERRORS {
        let error = session.body(body).expect_err(body);
        let text = format!("{error:?}");
        assert_eq!(error.apt3(), Some(*number), "{body}: {text}");
        assert!(text.contains(evidence), "{body}: {text} does not show {evidence}");
    }
}

#[test]
fn a_vertical_z_surface_gives_no_z() {
    let mut session = session();
    session.run("ZSURF/1,0,0,5").expect("a plane");
    let error = session.body("POINT/1,2").expect_err("no z");
    assert!(format!("{error:?}").contains("VerticalZSurface"));
    session.run("ZSURF/0,0,2,5").expect("a plane");
    assert_eq!(session.body("POINT/1,2").expect("a point").canonical_values(), [1.0, 2.0, 2.5]);
}
