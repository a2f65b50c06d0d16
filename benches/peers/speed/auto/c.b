# Phase B from A -> B on to where the rod touches the left parabola; x of the clamp, t, f and the arc length of the contact.
NDIM = 4, IPS = 4, IRS = 0, ILP = 0
ICP = [1, 2, 3, 4]
NBC = 7, NINT = 0, JAC = 1, NPAR = 4
IAD = 3, ISP = 0, ISW = 1, IPLT = 0
NPR = 0, MXBF = 0, IID = 0, ITMX = 8, ITNW = 7, NWTN = 3
# the arclength is the way of the clamp, so that states are at the same poses as those of others
THU = {1: 0, 2: 0, 3: 0, 4: 0}
THL = {1: 1, 2: 0, 3: 0, 4: 0}
DS = -1e-3, DSMIN = 1e-3, DSMAX = 1e-3, IADS = 0
