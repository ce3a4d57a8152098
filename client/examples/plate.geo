// SPDX-License-Identifier: GPL-3.0-or-later
// A square plate with a round hole and a fibre to its right; gmsh -2 -format msh41 plate.geo makes plate.msh.
r = 0.25;
h = 0.12;

Point(1) = {-1, -1, 0, h};       Point(2) = {1, -1, 0, h};
Point(3) = {1, 0, 0, h};         Point(4) = {1, 1, 0, h};
Point(5) = {-1, 1, 0, h};        Point(6) = {-1, 0, 0, h};
Point(7) = {0, 0, 0, h};         // centre of the hole
Point(8) = {-r, 0, 0, h / 3};    Point(9) = {r, 0, 0, h / 3};
Point(10) = {0.5, 0, 0, h / 2};  Point(11) = {0.9, 0, 0, h / 2};

Line(1) = {6, 1};     Line(2) = {1, 2};     Line(3) = {2, 3};
Line(4) = {3, 4};     Line(5) = {4, 5};     Line(6) = {5, 6};
Circle(7) = {8, 7, 9};                      // lower half of the hole's rim
Circle(8) = {9, 7, 8};                      // upper half
Line(9) = {6, 8};                           // y = 0, from left to right: the plus side is above
Line(10) = {9, 10};   Line(11) = {10, 11};  Line(12) = {11, 3};

Curve Loop(1) = {1, 2, 3, -12, -11, -10, -7, -9};
Curve Loop(2) = {4, 5, 6, 9, -8, 10, 11, 12};
Plane Surface(1) = {1};
Plane Surface(2) = {2};

Physical Curve("dirichlet", 1) = {1, 2, 3, 4, 5, 6};
Physical Curve("neumann", 2) = {7, 8};
Physical Curve("glue", 3) = {9, 10, 12};
Physical Curve("delaminated:fibre", 4) = {11};
Physical Surface("below", 5) = {1};
Physical Surface("above", 6) = {2};
