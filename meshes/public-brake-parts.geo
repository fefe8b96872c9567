// The brake of ANSYS technology demonstration 1 for Gmsh, in millimetres, part by part as it was meshed there: rings, vanes, cylinder and hat
// have meshes of their own that do not match, to be joined by ties. Divisions are those of the published surface mesh (60,351 nodes).
//   gmsh -3 public-brake-parts.geo -setnumber layers 8 -o public-brake-parts.msh

SetFactory("OpenCASCADE");
DefineConstant[
  layers = {8, Name "Elements through the thickness of rings, vanes and pads (8 are published)"},
  size = {15, Name "Length of an element of the hat"},
  gap = {0.1, Name "Between pads and disc"}
];

Function Sector
  // Hexahedra between two radii and two angles, `height` from `z`; `counts` along the radius, around, along the axis.
  // Its sides between the radii are lines from `inside`() to `outside`() angles.
  middle = newp; Point(middle) = {0, 0, z};
  For q In {0:1}
    p = newp; Point(p) = {radius(0) * Cos(inside(q)), radius(0) * Sin(inside(q)), z}; corners(2 * q) = p;
    p = newp; Point(p) = {radius(1) * Cos(outside(q)), radius(1) * Sin(outside(q)), z}; corners(2 * q + 1) = p;
  EndFor
  a = newc; Circle(a) = {corners(0), middle, corners(2)};
  b = newc; Line(b) = {corners(2), corners(3)};
  c = newc; Circle(c) = {corners(1), middle, corners(3)};
  d = newc; Line(d) = {corners(0), corners(1)};
  Transfinite Curve{a, c} = counts(1) + 1;
  Transfinite Curve{b, d} = counts(0) + 1;
  l = newll; Curve Loop(l) = {a, b, -c, -d};
  s = news; Plane Surface(s) = {l};
  Transfinite Surface{s};
  Recombine Surface{s};
Return

Function Ring
  // A whole ring of `pieces` sectors that share their sides.
  sectors() = {}; ends() = {}; around = counts(1); counts(1) = around / pieces;
  middle = newp; Point(middle) = {0, 0, z};
  For q In {0:pieces-1}
    angle = 2 * Pi * q / pieces;
    For k In {0:1}
      p = newp; Point(p) = {radius(k) * Cos(angle), radius(k) * Sin(angle), z}; ends(2 * q + k) = p;
    EndFor
    d = newc; Line(d) = {ends(2 * q), ends(2 * q + 1)}; sides(q) = d;
    Transfinite Curve{d} = counts(0) + 1;
  EndFor
  For q In {0:pieces-1}
    n = (q + 1) % pieces;
    a = newc; Circle(a) = {ends(2 * q), middle, ends(2 * n)};
    c = newc; Circle(c) = {ends(2 * q + 1), middle, ends(2 * n + 1)};
    Transfinite Curve{a, c} = counts(1) + 1;
    l = newll; Curve Loop(l) = {a, sides(n), -c, -sides(q)};
    s = news; Plane Surface(s) = {l}; sectors() += s;
    Transfinite Surface{s};
    Recombine Surface{s};
  EndFor
  made() = Extrude{0, 0, height}{ Surface{sectors()}; Layers{counts(2)}; Recombine; };
  body() = {}; below() = sectors(); above() = {}; inner() = {}; outer() = {};
  For q In {0:pieces-1}
    above() += made(6 * q); body() += made(6 * q + 1); inner() += made(6 * q + 2); outer() += made(6 * q + 4);
  EndFor
Return

pieces = 4;
radius() = {125, 175}; counts() = {8, 32, layers}; height = 10;
z = 0;
Call Ring;
rings() = body(); outsides() = below(); insides() = above();
Physical Surface("lower_ring_inside") = inner();
z = 25; counts() = {8, 32, layers};
Call Ring;
Physical Volume("rings") = {rings(), body()};
Physical Surface("disc_faces") = {outsides(), above()};
Physical Surface("ring_insides") = {insides(), below()};
pieces = 3;
z = 0; radius() = {112.5, 125}; counts() = {4, 51, layers};
Call Ring;
Physical Volume("inner_ring") = body();
Physical Surface("inner_ring_inside") = inner();
Physical Surface("inner_ring_outside") = outer();
pieces = 4;
radius() = {105, 112.5}; counts() = {4, 64, 4}; height = 75;   // 62 are published
Call Ring;
Physical Volume("cylinder") = body();
Physical Surface("cylinder_inside") = inner();
Physical Surface("cylinder_outside") = outer();

// The vanes, 28.7 wide. (Published: 5 of 7 × 4 elements in plan, 8 of 6 × 4 and 8 of 6 × 3.)
bottom() = {}; top() = {}; body() = {};
For k In {0:20}
  angle = Pi / 2 + 2 * Pi * k / 21;
  radius() = {125, 175};
  half = Asin(28.7 / 2 / 125); inside() = {angle - half, angle + half};
  half = Asin(28.7 / 2 / 175); outside() = {angle - half, angle + half};
  counts() = {6, 4, layers}; z = 10;
  Call Sector;
  made() = Extrude{0, 0, 15}{ Surface{s}; Layers{layers}; Recombine; };
  bottom() += s; top() += made(0); body() += made(1);
EndFor
Physical Volume("vanes") = body();
Physical Surface("vane_ends") = {bottom(), top()};

// The hat, with its bore and five bolt holes.
Function Circles
  middle = newp; Point(middle) = {x, y, 65};
  loop() = {};
  For q In {0:1}
    p = newp; Point(p) = {x + r * Cos(q * Pi), y + r * Sin(q * Pi), 65}; corners(q) = p;
  EndFor
  top = newp; Point(top) = {x, y + r, 65};
  low = newp; Point(low) = {x, y - r, 65};
  at() = {corners(0), top, corners(1), low};
  For q In {0:3}
    c = newc; Circle(c) = {at(q), middle, at((q + 1) % 4)};
    Transfinite Curve{c} = count / 4 + 1;
    loop() += c;
  EndFor
  l = newll; Curve Loop(l) = loop();
  loops() += l;
Return
loops() = {}; x = 0; y = 0;
r = 105; count = 44;
Call Circles;
r = 40; count = 16;
Call Circles;
For k In {0:4}
  angle = Pi / 2 + 2 * Pi * k / 5;
  x = 75 * Cos(angle); y = 75 * Sin(angle); r = 10; count = 8;
  Call Circles;
EndFor
s = news; Plane Surface(s) = loops();
Recombine Surface{s};
made() = Extrude{0, 0, 10}{ Surface{s}; Layers{1}; Recombine; };
Physical Volume("hat") = made(1);
Physical Surface("hat_outside") = made({2:5});
Physical Surface("bore") = made({6:9});
Physical Surface("bolt_holes") = made({10:29});

// The pads.
faces() = {}; pads() = {};
For side In {0:1}
  radius() = {130, 167.5}; inside() = {Pi / 3, 2 * Pi / 3}; outside() = inside(); counts() = {4, 8};
  sign = 2 * side - 1;
  z = side ? 35 + gap : -gap;
  Call Sector;
  made() = Extrude{0, 0, sign * 15}{ Surface{s}; Layers{layers}; Recombine; };
  faces() += s; pads() += made(1);
  Physical Surface(Str(StrChoice(side, "pad_upper_back", "pad_lower_back"))) = made(0);
EndFor
Physical Volume("pads") = pads();
Physical Surface("linings") = faces();

Mesh.MeshSizeMax = size;
Mesh.Algorithm = 6;
Mesh.RecombinationAlgorithm = 1;
Mesh.ElementOrder = 2;
Mesh.SecondOrderIncomplete = 1;
