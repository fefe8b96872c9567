// The disc–slider rig for Gmsh, in millimetres: mid-surfaces of disc and slider, the bar's axis.
//   gmsh -2 disc-slider.geo -o disc-slider.msh
// Disc in the plane x = 0, centre at the origin, lowest rim point (0, 0, -a); slider below it, its upper face at the
// rim; bar along -x. Faces look to +x (disc) and +z (slider).

a = 75;           // disc radius
b = 20.75;           // hub radius (assumed)
bar = 75;        // hub centre to clamp (assumed)
length = 200;     // slider along x
width = 120;      // slider along y
h = 10;           // slider thickness: places its mid-plane
fine = 0.4;       // element size within fine_radius of the contact
fine_radius = 2;
growth = 0.25;    // of the size per distance
disc_size = 3;    // elsewhere on the disc
slider_size = 8;  // elsewhere on the slider

// Disc, from the bottom counterclockwise seen from +x.
Point(1) = {0, 0, 0};
For i In {0:3}
  Point(10 + i) = {0, a * Sin(i * Pi / 2), -a * Cos(i * Pi / 2)};
  Point(20 + i) = {0, b * Sin(i * Pi / 2), -b * Cos(i * Pi / 2)};
EndFor
For i In {0:3}
  Circle(10 + i) = {10 + i, 1, 10 + (i + 1) % 4};
  Circle(20 + i) = {20 + i, 1, 20 + (i + 1) % 4};
EndFor
Curve Loop(1) = {10, 11, 12, 13};
Curve Loop(2) = {20, 21, 22, 23};
Plane Surface(1) = {1, 2};

// Bar: ten elements.
Point(2) = {-bar, 0, 0};
Line(30) = {1, 2};
Transfinite Curve{30} = 11;

// Slider, with a node under the contact.
z = -(a + h / 2);
Point(40) = {-length / 2, -width / 2, z};
Point(41) = { length / 2, -width / 2, z};
Point(42) = { length / 2,  width / 2, z};
Point(43) = {-length / 2,  width / 2, z};
Point(44) = {0, 0, z};
Line(40) = {40, 41};
Line(41) = {41, 42};
Line(42) = {42, 43};
Line(43) = {43, 40};
Curve Loop(3) = {40, 41, 42, 43};
Plane Surface(2) = {3};
Point{44} In Surface{2};

// Sizes: h(d) = min(coarse, fine + growth max(0, d - fine_radius)).
Field[1] = Distance;
Field[1].PointsList = {10};
Field[2] = Threshold;
Field[2].InField = 1;
Field[2].SizeMin = fine;
Field[2].SizeMax = disc_size;
Field[2].DistMin = fine_radius;
Field[2].DistMax = fine_radius + (disc_size - fine) / growth;
Field[3] = Restrict;
Field[3].InField = 2;
Field[3].SurfacesList = {1};
Field[4] = Distance;
Field[4].PointsList = {44};
Field[5] = Threshold;
Field[5].InField = 4;
Field[5].SizeMin = fine;
Field[5].SizeMax = slider_size;
Field[5].DistMin = fine_radius;
Field[5].DistMax = fine_radius + (slider_size - fine) / growth;
Field[6] = Restrict;
Field[6].InField = 5;
Field[6].SurfacesList = {2};
Field[7] = Min;
Field[7].FieldsList = {3, 6};
Background Field = 7;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.Algorithm = 6;
Mesh.ElementOrder = 1;

Physical Surface("disc") = {1};
Physical Curve("rim") = {10, 11, 12, 13};
Physical Curve("hub") = {20, 21, 22, 23};
Physical Curve("bar") = {30};
Physical Point("bar_root") = {1};
Physical Point("bar_clamp") = {2};
Physical Surface("slider") = {2};
Physical Curve("slider_edge_x_min") = {43};
Physical Curve("slider_edge_x_max") = {41};
Physical Curve("slider_edge_y_min") = {40};
Physical Curve("slider_edge_y_max") = {42};
