"""The live page: sliders in a browser tab, answers from processes on this machine."""
