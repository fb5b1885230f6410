"""Whether the CAD kernel loads on this machine: asked once, in this process, as a library that is missing
crashes nothing and who asks mostly needs the kernel next (two seconds of loading)."""

from __future__ import annotations

from functools import cache

from flexspline.geometry.kernel import CadKernelError, load_kernel


@cache
def why_no_cad() -> str:
    """The reason, "" where it does."""
    try:
        load_kernel()
    except CadKernelError as error:
        return str(error)
    return ""
