/* order_reflexes.h - the part of order.c for touch and reflexes. */

static void wrong_reflexes(void)
{
    int count;

    Touch.size = sizeof Touch;
    Rule.size = sizeof Rule;
    REFUSED("sun2xp_touch", sun2xp_touch(HAND, 9, 9, &Touch), NO_FINGER);
    REFUSED("sun2xp_touch", sun2xp_touch(HAND, 2, 9, &Touch), "the number 9");
    REFUSED("sun2xp_tare_touch", sun2xp_tare_touch(HAND, 9), NO_FINGER);
    REFUSED("sun2xp_remove_reflex", sun2xp_remove_reflex(HAND, 9, 9), NO_FINGER);
    REFUSED("sun2xp_remove_reflex", sun2xp_remove_reflex(HAND, 2, 9), "reflex 9");
    Rule.condition = SUN2XP_WHEN_FORCE_ABOVE;
    Rule.reaction = SUN2XP_THEN_SOFTEN;
    Rule.bound = -1;
    Rule.stiffness[0][0] = NAN;
    Rule.priority = 300;
    Rule.refractory = 4000;
    REFUSED("sun2xp_install_reflex", sun2xp_install_reflex(HAND, 9, &Rule), NO_FINGER);
    REFUSED("sun2xp_install_reflex", sun2xp_install_reflex(HAND, 2, &Rule), "NaN");
    Rule.stiffness[0][0] = -1;
    REFUSED("sun2xp_install_reflex", sun2xp_install_reflex(HAND, 2, &Rule), "force");
    Rule.bound = 1000;
    REFUSED("sun2xp_install_reflex", sun2xp_install_reflex(HAND, 2, &Rule), "priority");
    Rule.priority = 255;
    REFUSED("sun2xp_install_reflex", sun2xp_install_reflex(HAND, 2, &Rule), "refractory");
    Rule.refractory = 0;
    REFUSED("sun2xp_install_reflex", sun2xp_install_reflex(HAND, 2, &Rule), "Kx");
    Rule.stiffness[0][0] = 1;
    for (count = 0; count < 16; count++)
        CHECK(sun2xp_install_reflex(HAND, 2, &Rule) > 0);
    REFUSED("sun2xp_install_reflex", sun2xp_install_reflex(HAND, 2, &Rule), "16 reflexes");
    CHECK(sun2xp_remove_reflex(HAND, 2, 0) == 0);
}
