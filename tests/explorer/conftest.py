"""Pages of the explorer are looked at in a browser."""

from browser import browser as browser
from browser import page as page
