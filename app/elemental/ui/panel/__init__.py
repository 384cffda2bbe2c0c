"""The panel's pages: each a free function over what it shows and the widgets it is made of."""
