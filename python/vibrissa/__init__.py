"""A flexible rod that is swept past objects, and the objects from the reactions at its clamp.

All quantities have SI units, angles are in rad and count counter-clockwise from x. A contour runs with the solid on its left.

Objects
    :class:`Rod`, uniform, tapered, of :class:`Section` parts, bent at rest, or on an :class:`ElasticClamp`; the shapes :class:`Line`, :class:`Parabola`,
    :class:`CircularArc`, :class:`EllipticArc`, :class:`Bezier`, :class:`Spline`, :class:`Polygon`, :class:`Svg`, :class:`Graph`,
    :class:`Curve`, or any object with ``frame(t)`` (:func:`check_contract`); :class:`Composite`.
A rod without contacts
    :func:`elastica` finds the equilibria under given forces, or with the tip loaded, pinned or clamped, with stability, as :class:`Elastica`.
Paths of the clamp
    :class:`ClampPath`, :class:`ClampArc`, :class:`ClampSpline`, :class:`ClampFunction`, :class:`Chain`.
Sweeps
    :func:`sweep` gives a :class:`Scan` of states and events; :class:`Scene` is a file with all of it. :class:`Follower` is moved
    step by step, :func:`equilibrium` is one pose with given contacts, :class:`Derivatives` are those of a state,
    :class:`TransitionDerivatives` those of an event.
Studies
    :func:`study` sweeps many scenes on the workers of any executor and writes one row for each; :func:`grid` makes the scenes,
    :class:`Study` is a file of them, :func:`read_study` reads the rows.
Scans to make
    :func:`reach` gives the parts of objects that straight scans can touch, as :class:`Reach`; :func:`plan` chooses the next scans from a
    reconstruction, as :class:`Plan`. :class:`Explorer` gives one :class:`Proposal` after another, from the samples of all scans so far.
From reactions to the object
    :func:`reconstruct` gives a :class:`Reconstruction`, :func:`reconstruct_together` one for each of several recordings of one object, :func:`single` the point of each sample on its own; :class:`Recording` reads files, :func:`simulate` makes recordings with
    noise, :class:`Live` answers while samples come.
Forces from shapes
    :func:`forces` gives :class:`Forces` from points on the rod, frame by frame; :mod:`vibrissa.tracking` reads WHISK, WhiskiWrap, DeepLabCut, SLEAP and
    CSV, :mod:`vibrissa.whiskers` has whiskers of rats and mice as rods.

``UNITS`` has the units of the fields of all arrays.
"""

from ._core import (
    UNITS,
    Bezier,
    Chain,
    CircularArc,
    ClampArc,
    ClampFunction,
    ClampPath,
    ClampSpline,
    Composite,
    Contact,
    Curve,
    Derivatives,
    Elastica,
    ElasticClamp,
    EllipticArc,
    Equilibrium,
    Event,
    Explorer,
    Follower,
    Forces,
    Graph,
    Line,
    Live,
    Parabola,
    Path,
    Polygon,
    Proposal,
    Reconstruction,
    Recording,
    Rod,
    Scan,
    Scene,
    Section,
    Shape,
    Spline,
    State,
    Study,
    Svg,
    TransitionDerivatives,
    __version__,
    check_contract,
    elastica,
    equilibrium,
    reconstruct,
    reconstruct_together,
    simulate,
    single,
    sweep,
)
from ._errors import SweepStopped
from ._forces import forces
from ._plan import Plan, plan
from ._ragged import Ragged
from ._reach import Reach, reach
from ._study import StudyBroken, grid, study
from ._study_files import read_study

__all__ = [
    "UNITS",
    "Bezier",
    "Chain",
    "CircularArc",
    "ClampArc",
    "ClampFunction",
    "ClampPath",
    "ClampSpline",
    "Composite",
    "Contact",
    "Curve",
    "Derivatives",
    "ElasticClamp",
    "Elastica",
    "EllipticArc",
    "Equilibrium",
    "Event",
    "Explorer",
    "Follower",
    "Forces",
    "Graph",
    "Line",
    "Live",
    "Parabola",
    "Path",
    "Plan",
    "Polygon",
    "Proposal",
    "Ragged",
    "Reach",
    "Reconstruction",
    "Recording",
    "Rod",
    "Scan",
    "Scene",
    "Section",
    "Shape",
    "Spline",
    "State",
    "Study",
    "StudyBroken",
    "Svg",
    "SweepStopped",
    "TransitionDerivatives",
    "__version__",
    "check_contract",
    "elastica",
    "equilibrium",
    "forces",
    "grid",
    "plan",
    "reach",
    "read_study",
    "reconstruct",
    "reconstruct_together",
    "simulate",
    "single",
    "study",
    "sweep",
]
