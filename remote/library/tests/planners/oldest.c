/* Has no include and no prototypes, uses float arrays, waits with sleep, and ignores return values. */
float Pos[3], Kx[9];

main()
{
    int i;

    for (i = 0; i < 9; i++)
        Kx[i] = i % 4 == 0 ? 4.0 : 0.0;
    OpenHand();
    SendKx(1, Kx);
    Pos[0] = 0.1;
    Pos[1] = 0.6;
    Pos[2] = 0.9;
    SendPos(1, Pos);
    sleep(4);
    GetPos(1, Pos);
    printf("%.3f %.3f %.3f\n", Pos[0], Pos[1], Pos[2]);
    CloseHand();
    return 0;
}
