"""Types of arguments and results, for annotations; type checkers alone look at them.

Array    an array of NumPy, in place: its type of number and shape are as the function says
Numbers  a few numbers, which are copied: an array, or nested sequences
Pose     a textplane.SE3, or a matrix (4, 4) or (3, 4)
"""
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from typing import Any, Union

    from numpy.typing import ArrayLike, NDArray

    from ._core import SE3

    Array = NDArray[Any]
    Numbers = ArrayLike
    Pose = Union[SE3, NDArray[Any]]
