// SPDX-License-Identifier: GPL-3.0-or-later
// omega = (-1, 1) x (0, 1), gamma on its lower side, and the box below gamma; gmsh -2 -format msh41
// section-6.geo makes section-6.msh.
h = 0.16;
t = 0.0005;                             // at the ends of gamma, where u behaves like r^(1/2)

Point(1) = {-1, 0, 0, h};               Point(2) = {-0.5, 0, 0, t};
Point(3) = {0, 0, 0, h / 2};            Point(4) = {0.5, 0, 0, t};
Point(5) = {1, 0, 0, h};                Point(6) = {1, 1, 0, h};
Point(7) = {-1, 1, 0, h};
Point(8) = {-0.5, -0.25, 0, h};         Point(9) = {0.5, -0.25, 0, h};

Line(1) = {1, 2};   Line(2) = {2, 3};   Line(3) = {3, 4};   Line(4) = {4, 5};
Line(5) = {5, 6};   Line(6) = {6, 7};   Line(7) = {7, 1};
Line(8) = {2, 8};   Line(9) = {8, 9};   Line(10) = {9, 4};

Curve Loop(1) = {1, 2, 3, 4, 5, 6, 7};
Curve Loop(2) = {8, 9, 10, -3, -2};
Plane Surface(1) = {1};
Plane Surface(2) = {2};

Physical Curve("inclusion:gamma", 1) = {2, 3};
Physical Curve("dirichlet", 2) = {5, 6, 7};
Physical Curve("neumann", 3) = {1, 4, 8, 9, 10};
Physical Surface("omega", 4) = {1};
Physical Surface("box", 5) = {2};
