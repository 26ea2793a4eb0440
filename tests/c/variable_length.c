/* Passes arrays of variable length (C99) to the calls. The compiler must choose between the calls for float and for
   double, although it does not know the size of a row. */
#include "Sun2Xp.h"
#include "check.h"
#include "refused.h"

static void try_rows(int n, double Given[n][n])
{
    double Kx[n][n], Pos[n];
    float KxSingle[n][n], PosSingle[n];
    int row, column;

    for (row = 0; row < n; row++)
        for (column = 0; column < n; column++)
            Kx[row][column] = KxSingle[row][column] = Given[row][column] = row == column ? 3 : 0;
    CHECK(SendKx(1, Kx) == 0 && SendKx(1, &Kx) == 0);
    CHECK(SendKx(1, KxSingle) == 0 && SendKx(1, &KxSingle) == 0);
    CHECK(SendKx(1, Given) == 0);
    CHECK(GetPos(1, Pos) == 0 && GetPos(1, PosSingle) == 0);
    CHECK(APART(Pos[1], PosSingle[1]) < 0.02);
    CHECK(SendPos(1, Pos) == 0 && SendPos(1, PosSingle) == 0);
    Kx[2][1] = KxSingle[2][1] = 1;
    REFUSED(SendKx(1, Kx), EDOM, "[1][2]");
    REFUSED(SendKx(1, KxSingle), EDOM, "[1][2]");
}

int main(void)
{
    double Given[3][3];

    CHECK(OpenHand() == 0);
    try_rows(3, Given);
    return CloseHand();
}
