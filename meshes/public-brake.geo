// The brake of ANSYS technology demonstration 1 for Gmsh, in millimetres: a ventilated disc with its hat and bolt holes, and two pads.
//   gmsh -3 public-brake.geo -setnumber size 12.5 -setnumber cells 0 -o public-brake.msh
// The plan of the disc, seen along its axis z, is meshed once and extruded through five storeys; a storey keeps the cells that
// are material there.

SetFactory("OpenCASCADE");
DefineConstant[
  size = {12.5, Name "Length of an element"},
  pad_size = {size, Name "The same of the pads"},
  cells = {0, Name "0 hexahedra, 1 wedges, 2 tetrahedra"},
  turn = {0, Name "Angle of the pads from the middle of a vane, in degrees"},
  holes_turn = {0, Name "Angle of the first bolt hole from there, in degrees"}
];

vanes = 21;
width = 28.7;                         // of a vane
radii() = {105, 112.5, 125, 175};     // inside and outside of the cylinder, of the rings
bore = 40;
holes = 5; hole = 10; pitch = 75;     // bolt holes: number, radius, radius of their middles
pad_inside = 130; pad_outside = 167.5; pad_angle = Pi / 3; pad_height = 15;
levels() = {0, 10, 25, 35, 65, 75};   // ring, vanes, ring, cylinder, hat

Function CountOf   // elements along `length`
  count = Ceil(length / size - 0.5);
  If (count < 1)
    count = 1;
  EndIf
Return

// The plan. Lines at the edges of vanes are parallel to the middle of the vane between the rings' radii, and radial inside.
origin = newp; Point(origin) = {0, 0, 0};
For k In {0:vanes-1}
  For side In {0:1}
    For j In {0:3}
      r = radii(j);
      If (j < 2)
        half = Asin(width / 2 / radii(2));
      Else
        half = Asin(width / 2 / r);
      EndIf
      angle = Pi / 2 + 2 * Pi * k / vanes + (2 * side - 1) * half;
      p = newp; Point(p) = {r * Cos(angle), r * Sin(angle), 0};
      points((2 * k + side) * 4 + j) = p;
    EndFor
  EndFor
EndFor
edges = 2 * vanes;
For e In {0:edges-1}
  next = (e + 1) % edges;
  length = width;
  Call CountOf;
  If (e % 2)   // an even number from vane to vane, as a plan of quadrilaterals alone needs
    along = count;
    length = 2 * Pi * 150 / vanes - width;
    Call CountOf;
    count += (count + along) % 2;
  EndIf
  For j In {0:3}
    c = newc; Circle(c) = {points(e * 4 + j), origin, points(next * 4 + j)};
    Transfinite Curve{c} = count + 1;
    arcs(e * 4 + j) = c;
  EndFor
  For j In {0:2}
    c = newc; Line(c) = {points(e * 4 + j), points(e * 4 + j + 1)};
    length = radii(j + 1) - radii(j);
    Call CountOf;
    Transfinite Curve{c} = count + 1;
    radials(e * 3 + j) = c;
  EndFor
EndFor
cylinder() = {}; inner() = {}; vane() = {}; gap() = {};
For e In {0:edges-1}
  next = (e + 1) % edges;
  For j In {0:2}
    l = newll; Curve Loop(l) = {arcs(e * 4 + j), radials(next * 3 + j), -arcs(e * 4 + j + 1), -radials(e * 3 + j)};
    s = news; Plane Surface(s) = {l};
    Transfinite Surface{s};
    If (j == 0)
      cylinder() += s;
    ElseIf (j == 1)
      inner() += s;
    ElseIf (e % 2 == 0)
      vane() += s;
    Else
      gap() += s;
    EndIf
  EndFor
EndFor
Function Ring   // a circle of `radius` about (x, y) in four arcs
  middle = newp; Point(middle) = {x, y, 0};
  For q In {0:3}
    p = newp; Point(p) = {x + radius * Cos(q * Pi / 2), y + radius * Sin(q * Pi / 2), 0, size};
    corners(q) = p;
  EndFor
  ring() = {};
  For q In {0:3}
    c = newc; Circle(c) = {corners(q), middle, corners((q + 1) % 4)};
    length = radius * Pi / 2;
    Call CountOf;
    Transfinite Curve{c} = (count < 2 ? 2 : count) + 1;
    ring() += c;
  EndFor
  l = newll; Curve Loop(l) = ring();
  loops() += l;
Return
outside() = {};
For e In {0:edges-1}
  outside() += arcs(e * 4);
EndFor
l = newll; Curve Loop(l) = outside(); loops() = {l};
x = 0; y = 0; radius = bore;
Call Ring;
For h In {0:holes-1}
  angle = Pi / 2 + holes_turn * Pi / 180 + 2 * Pi * h / holes;
  x = pitch * Cos(angle); y = pitch * Sin(angle); radius = hole;
  Call Ring;
EndFor
hat = news; Plane Surface(hat) = loops();
plan() = {cylinder(), inner(), vane(), gap(), hat};
If (cells == 0)
  Recombine Surface{plan()};
EndIf

// The storeys. Of an extruded surface come its copy above, its volume, and a face for each of its curves in their order.
disc() = {}; lower() = {}; upper() = {}; inside() = {}; bored() = {}; bolted() = {};
n1 = #cylinder(); n2 = n1 + #inner(); n3 = n2 + #vane(); n4 = n3 + #gap();
For storey In {0:4}
  length = levels(storey + 1) - levels(storey);
  Call CountOf;
  If (cells == 2)
    made() = Extrude{0, 0, length}{ Surface{plan()}; Layers{count}; };
  Else
    made() = Extrude{0, 0, length}{ Surface{plan()}; Layers{count}; Recombine; };
  EndIf
  above() = {};
  For i In {0:n4}
    of = 6 * i;
    above() += made(of);
    rings = (storey == 0 || storey == 2);
    If (i < n1)
      disc() += made(of + 1);
      If (storey < 4)
        inside() += made(of + 2);
      EndIf
    ElseIf (i < n2)
      If (storey == 0)
        disc() += made(of + 1);
      EndIf
    ElseIf (i < n4)
      If (rings || (storey == 1 && i < n3))
        disc() += made(of + 1);
      EndIf
      If (storey == 0)
        lower() += plan(i);
      ElseIf (storey == 2)
        upper() += made(of);
      EndIf
    ElseIf (storey == 4)
      disc() += made(of + 1);
      bored() = made({of + 2 + edges : of + 5 + edges});
      bolted() = made({of + 6 + edges : of + 5 + edges + 4 * holes});
    EndIf
  EndFor
  plan() = above();
EndFor

// The pads, on the lower and on the upper face.
Mesh.MeshSizeMax = size;
size = pad_size;
faces() = {}; pads() = {};
For side In {0:1}
  z = side ? levels(3) : levels(0);
  middle = newp; Point(middle) = {0, 0, z};
  For q In {0:1}
    angle = Pi / 2 + turn * Pi / 180 + (q - 0.5) * pad_angle;
    p = newp; Point(p) = {pad_inside * Cos(angle), pad_inside * Sin(angle), z}; corners(2 * q) = p;
    p = newp; Point(p) = {pad_outside * Cos(angle), pad_outside * Sin(angle), z}; corners(2 * q + 1) = p;
  EndFor
  a = newc; Circle(a) = {corners(0), middle, corners(2)};
  b = newc; Line(b) = {corners(2), corners(3)};
  c = newc; Circle(c) = {corners(1), middle, corners(3)};
  d = newc; Line(d) = {corners(0), corners(1)};
  length = pad_angle * (pad_inside + pad_outside) / 2;
  Call CountOf;
  Transfinite Curve{a, c} = count + 1;
  length = pad_outside - pad_inside;
  Call CountOf;
  Transfinite Curve{b, d} = count + 1;
  l = newll; Curve Loop(l) = {a, b, -c, -d};
  s = news; Plane Surface(s) = {l};
  Transfinite Surface{s};
  If (cells == 0)
    Recombine Surface{s};
  EndIf
  length = pad_height;
  Call CountOf;
  If (cells == 2)
    made() = Extrude{0, 0, (2 * side - 1) * pad_height}{ Surface{s}; Layers{count}; };
  Else
    made() = Extrude{0, 0, (2 * side - 1) * pad_height}{ Surface{s}; Layers{count}; Recombine; };
  EndIf
  name = StrChoice(side, "pad_upper", "pad_lower");
  pads() += made(1);
  faces() += s;
  Physical Surface(StrCat(name, "_back")) = made(0);
EndFor

Physical Volume("pads") = pads();
Physical Surface("linings") = faces();
Physical Volume("disc") = disc();
Physical Surface("disc_faces") = {lower(), upper()};
Physical Surface("cylinder_inside") = inside();
Physical Surface("bore") = bored();
Physical Surface("bolt_holes") = bolted();

Mesh.Algorithm = 6;
Mesh.RecombinationAlgorithm = 1;
Mesh.ElementOrder = 2;
Mesh.SecondOrderIncomplete = 1;
