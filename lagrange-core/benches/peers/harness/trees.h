/* How the joints of bodies in space hang together: TREE(name, axes, parents...). Each joint turns about an axis of its
 * link; F is a free base, -1 the ground. generators/with_casadi_robots.py reads this file too. */
TREE(arm_6, "zzzzzz", -1, 0, 1, 2, 3, 4)
TREE(denavit_6, "zzzzzz", -1, 0, 1, 2, 3, 4)
TREE(arm_20, "zzzzzzzzzzzzzzzzzzzz", -1, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18)
/* Four legs of hip, thigh and shank. */
TREE(quadruped_0, "Fxyyxyyxyyxyy", -1, 0, 1, 2, 0, 4, 5, 0, 7, 8, 0, 10, 11)
/* Two legs (hip zxy, knee, ankle yx), waist zy, head zy, two arms (shoulder yxz, elbow, wrist zxy). */
TREE(humanoid_0, "Fzxyyyxzxyyyxzyzyyxzyzxyyxzyzxy",
     -1, 0, 1, 2, 3, 4, 5, 0, 7, 8, 9, 10, 11, 0, 13, 14, 15, 14, 17, 18, 19, 20, 21, 22, 14, 24, 25, 26, 27, 28, 29)
