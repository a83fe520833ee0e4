import './style.css';
import './stage.css';
import './aside.css';

import { find } from './elements';
import { Viewer } from './viewer';

try {
  void new Viewer().start();
} catch {
  find('alert').hidden = false;
  find('alert-text').textContent =
    'This browser has no WebGL, which the pictures need. The service works without the page: see openapi.json.';
}
