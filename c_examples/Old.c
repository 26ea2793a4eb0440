/* Old.c - a planner in the C of 1990: no header of the hand, no prototypes, implicit int, and results that are
   ignored. The functions are those for arrays of float. For a planner like this one with arrays of double, add
   -DREAL=double -DSendPos=SendPosD -DSendKx=SendKxD -DGetPos=GetPosD.

       gcc -std=gnu89 Old.c -lsun2xp */

#include <stdio.h>

#ifndef REAL
#define REAL float
#endif

REAL Open[3] = {0.0, 0.3, 0.8};
REAL Closed[3] = {0.0, 0.8, 1.3};
REAL Kx[3][3] = {{3.0, 0.0, 0.0}, {0.0, 3.0, 0.0}, {0.0, 0.0, 3.0}};

grasp(i, Pos)
int i;
REAL *Pos;
{
  SendKx(i, Kx);
  SendPos(i, Pos);
}

main( )
{
  REAL Pos[3];
  int i, arrived;

  OpenHand( );
  for (i = 1; i <= 3; i++)
    grasp(i, Open);
  sleep(3);
  for (i = 1; i <= 3; i++)
    grasp(i, Closed);
  sleep(4);
  arrived = 0;
  for (i = 1; i <= 3; i++) {
    GetPos(i, Pos);
    printf("finger %d is at %f %f %f\n", i, Pos[0], Pos[1], Pos[2]);
    if (Pos[2] > 1.28 && Pos[2] < 1.32)
      arrived++;
  }
  CloseHand( );
  exit(arrived == 3 ? 0 : 1);
}
