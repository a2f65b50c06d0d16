! A clamped rod on N tangential contacts with the parabolas of O1, as boundary-value problem of AUTO-07p; N = NDIM / 4.
!
! U: x, y, phi, kappa of each segment, from the clamp to the tip, over T = 0..1.
! PAR(1): x of the clamp; PAR(3 j - 1 .. 3 j + 1): parameter t, force f of contact j, length of the segment that ends there.
! x' = cos phi, y' = sin phi, phi' = kappa, kappa' = A cos phi + B sin phi, A = sum f cos alpha, B = sum f sin alpha over the
! contacts ahead.
module object
  implicit none
  double precision, parameter :: y0 = -0.4d0, phi0 = 1.5707963267948966d0, c = 5d0
contains
  ! x of the vertex: the last contact is with the right parabola, one before it with the left one.
  double precision function vertex(j, n)
    integer, intent(in) :: j, n
    vertex = merge(0.3d0, 0d0, j == n)
  end function

  ! Position and tangent angle at t, and their rates.
  subroutine frame(xv, t, at, rate)
    double precision, intent(in) :: xv, t
    double precision, intent(out) :: at(3), rate(3)
    at = [xv + t, c * t**2, atan(2 * c * t)]
    rate = [1d0, 2 * c * t, 2 * c / (1 + (2 * c * t)**2)]
  end subroutine
end module

subroutine func(ndim, u, icp, par, ijac, f, dfdu, dfdp)
  use object
  implicit none
  integer, intent(in) :: ndim, icp(*), ijac
  double precision, intent(in) :: u(ndim), par(*)
  double precision, intent(out) :: f(ndim)
  double precision, intent(inout) :: dfdu(ndim, ndim), dfdp(ndim, *)
  integer :: n, j, k, i
  double precision :: a, b, sine, cosine, length, at(3), rate(3)
  n = ndim / 4
  a = 0
  b = 0
  if (ijac /= 0) dfdu = 0
  if (ijac == 2) dfdp(:, 1:3 * n + 1) = 0
  do j = n, 1, -1
    i = 4 * j - 3
    call frame(vertex(j, n), par(3 * j - 1), at, rate)
    a = a + par(3 * j) * cos(at(3))
    b = b + par(3 * j) * sin(at(3))
    length = par(3 * j + 1)
    sine = sin(u(i + 2))
    cosine = cos(u(i + 2))
    f(i:i + 3) = length * [cosine, sine, u(i + 3), a * cosine + b * sine]
    if (ijac == 0) cycle
    dfdu(i:i + 3, i + 2) = length * [-sine, cosine, 0d0, b * cosine - a * sine]
    dfdu(i + 2, i + 3) = length
    if (ijac == 1) cycle
    dfdp(i:i + 3, 3 * j + 1) = f(i:i + 3) / length
    do k = j, n
      call frame(vertex(k, n), par(3 * k - 1), at, rate)
      dfdp(i + 3, 3 * k - 1) = length * par(3 * k) * rate(3) * sin(u(i + 2) - at(3))
      dfdp(i + 3, 3 * k) = length * cos(u(i + 2) - at(3))
    end do
  end do
end subroutine

subroutine stpnt(ndim, u, par, t)
  implicit none
  integer, intent(in) :: ndim
  double precision, intent(inout) :: u(ndim), par(*)
  double precision, intent(in) :: t
  ! u comes from the file that `dat` names, par from the constants
end subroutine

subroutine bcnd(ndim, par, icp, nbc, u0, u1, fb, ijac, dbc)
  use object
  implicit none
  integer, intent(in) :: ndim, icp(*), nbc, ijac
  double precision, intent(in) :: par(*), u0(ndim), u1(ndim)
  double precision, intent(out) :: fb(nbc)
  double precision, intent(inout) :: dbc(nbc, *)
  integer :: n, j, i, row, d, k, p
  double precision :: at(3), rate(3)
  n = ndim / 4
  p = 2 * ndim
  if (ijac /= 0) dbc(:, 1:p + 3 * n + 1) = 0
  fb(1:3) = u0(1:3) - [par(1), y0, phi0]
  if (ijac /= 0) then
    do k = 1, 3
      dbc(k, k) = 1
    end do
    dbc(1, p + 1) = -1
  end if
  row = 3
  do j = 1, n
    i = 4 * j - 3
    call frame(vertex(j, n), par(3 * j - 1), at, rate)
    ! the segment ends on the contact
    fb(row + 1:row + 3) = u1(i:i + 2) - at
    if (ijac /= 0) then
      do k = 1, 3
        dbc(row + k, ndim + i + k - 1) = 1
      end do
      dbc(row + 1:row + 3, p + 3 * j - 1) = -rate
    end if
    row = row + 3
    if (j < n) then
      ! the next one begins there
      d = i + 4
      fb(row + 1:row + 3) = u0(d:d + 2) - at
      fb(row + 4) = u0(d + 3) - u1(i + 3)
      if (ijac /= 0) then
        do k = 1, 3
          dbc(row + k, d + k - 1) = 1
        end do
        dbc(row + 1:row + 3, p + 3 * j - 1) = -rate
        dbc(row + 4, d + 3) = 1
        dbc(row + 4, ndim + i + 3) = -1
      end if
      row = row + 4
    else
      fb(row + 1) = u1(i + 3)
      if (ijac /= 0) dbc(row + 1, ndim + i + 3) = 1
    end if
  end do
end subroutine

! Every state with all its digits, where it was compiled to tell them.
subroutine pvls(ndim, u, par)
  implicit none
  integer, intent(in) :: ndim
  double precision, intent(in) :: u(ndim, *), par(*)
#ifdef TELL
  double precision, external :: getp
  write (21, '(*(es25.17))') par(1:3 * (ndim / 4) + 1), getp('BV0', 4, u)
#endif
end subroutine

subroutine icnd
end subroutine

subroutine fopt
end subroutine
