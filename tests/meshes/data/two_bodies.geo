// A wire of 1 x 1 x 2 mm on one half of a silicone block of 2 x 1 x 1 mm: 24 hexahedra in metres.
// two_bodies_41.msh and two_bodies_22.msh are what Gmsh 4.8.4 makes of it:
//   gmsh -3 -format msh41 -o two_bodies_41.msh two_bodies.geo     (and msh22)
mm = 1e-3;
Point(1) = {0, 0, 0};
Point(2) = {mm, 0, 0};
Point(3) = {2 * mm, 0, 0};
Point(4) = {0, mm, 0};
Point(5) = {mm, mm, 0};
Point(6) = {2 * mm, mm, 0};
Line(1) = {1, 2};
Line(2) = {2, 5};
Line(3) = {5, 4};
Line(4) = {4, 1};
Line(5) = {2, 3};
Line(6) = {3, 6};
Line(7) = {6, 5};
Curve Loop(1) = {1, 2, 3, 4};
Curve Loop(2) = {5, 6, 7, -2};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Transfinite Curve {1:7} = 3;
Transfinite Surface {1:2};
Recombine Surface {1:2};
left[] = Extrude {0, 0, mm} { Surface{1}; Layers{2}; Recombine; };
right[] = Extrude {0, 0, mm} { Surface{2}; Layers{2}; Recombine; };
wire[] = Extrude {0, 0, 2 * mm} { Surface{left[0]}; Layers{2}; Recombine; };
Physical Volume("wire") = {wire[1]};
Physical Volume("silicone") = {left[1], right[1]};
Physical Surface("wire_surface") = {wire[0], wire[2], wire[3], wire[4], wire[5]};
Physical Surface("silicone_surface") = {left[2], left[4], left[5], right[0], right[2], right[3], right[4]};
Physical Surface("clamp") = {1, 2};
