/* order_reflexes.h - the refusals of touch and reflexes, for order.c. */

static void wrong_reflexes(void)
{
    int count;

    Touch.Size = sizeof Touch;
    Rule.Size = sizeof Rule;
    REFUSED("GetTouch", GetTouch(9, 9, &Touch), NO_FINGER);
    REFUSED("GetTouch", GetTouch(2, 9, &Touch), "the number 9");
    REFUSED("TareTouch", TareTouch(9), NO_FINGER);
    REFUSED("RemoveReflex", RemoveReflex(9, 9), NO_FINGER);
    REFUSED("RemoveReflex", RemoveReflex(2, 9), "reflex 9");
    Rule.Condition = WHEN_FORCE_ABOVE;
    Rule.Reaction = THEN_SOFTEN;
    Rule.Bound = -1;
    Rule.Kx[0][0] = -1;
    REFUSED("InstallReflex", InstallReflex(9, &Rule), NO_FINGER);
    REFUSED("InstallReflex", InstallReflex(2, &Rule), "force");
    Rule.Bound = 1000;
    REFUSED("InstallReflex", InstallReflex(2, &Rule), "Kx");
    Rule.Kx[0][0] = 1;
    for (count = 0; count < 16; count++)
        CHECK(InstallReflex(2, &Rule) > 0);
    REFUSED("InstallReflex", InstallReflex(2, &Rule), "16 reflexes");
    CHECK(RemoveReflex(2, 0) == 0);
}
