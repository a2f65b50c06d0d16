# Phase BB from B -> BB on; x of the clamp, t, f and length of the segment of both contacts.
NDIM = 8, IPS = 4, IRS = 0, ILP = 0
ICP = [1, 2, 3, 4, 5, 6, 7]
NBC = 14, NINT = 0, JAC = 1, NPAR = 7
IAD = 3, ISP = 0, ISW = 1, IPLT = 0
NPR = 0, MXBF = 0, IID = 0, ITMX = 8, ITNW = 7, NWTN = 3
THU = {1: 0, 2: 0, 3: 0, 4: 0, 5: 0, 6: 0, 7: 0, 8: 0}
THL = {1: 1, 2: 0, 3: 0, 4: 0, 5: 0, 6: 0, 7: 0}
DS = -2e-4, DSMIN = 2e-4, DSMAX = 2e-4, IADS = 0
