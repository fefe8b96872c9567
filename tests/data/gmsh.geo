// Two faces, one triangulated, one of quadrilaterals, and a bar: made by Gmsh 4.15 into gmsh-{22,41}-{ascii,binary}.msh by
//   gmsh -2 gmsh.geo -format msh41 [-bin] -o gmsh-41-ascii.msh
// and gmsh-second-order.msh with -order 2.
h=1;
Point(1)={0,0,0,h};Point(2)={3,0,0,h};Point(3)={3,2,0,h};Point(4)={0,2,0,h};Point(5)={0,0,2,h};Point(6)={6,0,0,h};Point(7)={6,2,0,h};
Line(1)={1,2};Line(2)={2,3};Line(3)={3,4};Line(4)={4,1};Line(5)={1,5};Line(6)={2,6};Line(7)={6,7};Line(8)={7,3};
Curve Loop(1)={1,2,3,4};Plane Surface(1)={1};
Curve Loop(2)={6,7,8,-2};Plane Surface(2)={2};
Transfinite Surface{2};Recombine Surface{2};
Physical Surface("plate")={1,2};Physical Surface("left half")={1};
Physical Curve("clamped edge")={4};Physical Curve("bar")={5};Physical Point("tip")={5};
